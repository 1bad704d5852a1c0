// motor by hand: open the Serial Monitor at 115200 baud, line ending "Newline", and type help.
//
// The sketch reads and answers while they move; nothing in it waits.
// The spec's `uses` does not name Serial: the highest rate is proven without its interrupts. Name
// it there before going to that limit.

#include <VariableSpeed.h>

static const char kHelp[] PROGMEM =
    "speed 500    turn at 500 steps/s, backward with -500\n"
    "steps 2000   make 2000 steps at that speed, or -2000\n"
    "stop         at once, coils off\n"
    "hold         coils on, while it stands\n"
    "release      coils off, while it stands\n"
    "ramp         from 100 to 400 steps/s by update events\n"
    "status       does it run, and where is it\n";

// What can be asked of a motor.
struct Motor {
  const char *name;
  uint32_t interval;  // I/O clocks between two steps of the next motion
  int8_t (*setSpeed)(uint8_t control, uint32_t interval, uint32_t limit);
  uint8_t (*readStatus)();
  int32_t (*readPosition)();
  int8_t (*hold)();
  int8_t (*release)();
  int8_t (*ramp)();
};

static int8_t motorStart(uint8_t control, uint32_t interval, uint32_t limit) {
  return motorSetSpeed(control, interval, limit);
}

// 60 update events, one each 50 ms, shorten the interval by 2000 I/O clocks each.
static int8_t motorRamp() {
  const uint8_t control = MOTOR_CTRL_SPEED_VARIABLE | MOTOR_CTRL_IRQ_TIMING | MOTOR_CTRL_FASTER;
  return motorSetSpeed(
      control | MOTOR_CTRL_DRV_EN, 160000UL, 0, 2000UL, 50, 60);
}

static Motor motors[] = {
    {"motor", 0,
     motorStart, motorReadStatus, motorReadPosition, motorHold, motorRelease, motorRamp},
};

constexpr int kRoom = 62;  // no line that is printed is longer; the core has room for more

static char line[64];                   // what was typed; more than fits is cut off
static const char *helpLeft = nullptr;  // what of the help is still to be printed

// Prints the next line of the help; behind the last one there is none.
static void printHelpLine() {
  char letter;
  do {
    letter = pgm_read_byte(helpLeft++);
    Serial.write(letter);
  } while (letter != '\n');
  if (!pgm_read_byte(helpLeft)) helpLeft = nullptr;
}

// Collects what is typed, without waiting for it; tells whether a line is complete.
static bool readLine() {
  static uint8_t length = 0;
  while (Serial.available()) {
    const char letter = Serial.read();
    if (letter == '\n' || letter == '\r') {
      line[length] = '\0';
      length = 0;
      return true;
    }
    if (length < sizeof(line) - 1) line[length++] = letter;
  }
  return false;
}

// Tells whether the word is this one.
static bool is(const char *word, const __FlashStringHelper *known) {
  return strcmp_P(word, reinterpret_cast<const char *>(known)) == 0;
}

// Reads a whole number; tells whether there is one and nothing else.
static bool readNumber(const char *text, int32_t &number) {
  if (!text) return false;
  char *end;
  number = strtol(text, &end, 10);
  return end != text && *end == '\0';
}

// Says it on a line of its own.
static void say(const __FlashStringHelper *words) {
  Serial.println(words);
}

// Says what the library answered.
static void answer(int8_t result) {
  switch (result) {
    case 0: return say(F("ok"));
    case MOTOR_ERROR_RUNNING: return say(F("not while it runs"));
    default: return say(F("refused"));
  }
}

// Says what was not understood.
static void ask() {
  say(F("what? type help"));
}

// Says where a motor is, and whether it moves.
static void printPosition(const char *name, bool runs, int32_t position) {
  Serial.print(name);
  Serial.print(runs ? F(" running, at step ") : F(" at rest, at step "));
  Serial.println(position);
}

// Without its sign.
static uint32_t magnitude(int32_t number) {
  return number < 0 ? -static_cast<uint32_t>(number) : number;
}

// The control byte for driving that way.
static uint8_t controlFor(int32_t number) {
  return number < 0 ? MOTOR_CTRL_DRV_EN | MOTOR_CTRL_DIRECTION : MOTOR_CTRL_DRV_EN;
}

// The I/O clocks between two steps at that many steps per second; 1, which is refused, for more
// than motorTimerCalcPerSecond() takes.
static uint32_t intervalFor(int32_t speed) {
  return magnitude(speed) > 65535 ? 1 : motorTimerCalcPerSecond(magnitude(speed));
}

// Turns at that speed until something else is asked for.
static void turn(Motor &motor, int32_t speed) {
  const int8_t result = motor.setSpeed(controlFor(speed), intervalFor(speed), 0);
  if (result == MOTOR_ERROR_TOO_FAST) {
    Serial.print(F("too fast: at most "));
    Serial.println(static_cast<uint32_t>(F_CPU / MOTOR_MIN_TOP));
    return;
  }
  if (result == 0) motor.interval = intervalFor(speed);
  answer(result);
}

static void stop(const Motor &motor) {
  motor.setSpeed(0, 0, 0);
}

static void printStatus(const Motor &motor) {
  printPosition(motor.name, !(motor.readStatus() & MOTOR_STAT_REACHED), motor.readPosition());
}

// Does what the words say.
static void obey(Motor &motor, const char *word, const char *rest) {
  int32_t number = 0;
  const bool numbered = readNumber(rest, number) && number != 0;
  if (is(word, F("speed")) && numbered) {
    turn(motor, number);
  } else if (is(word, F("steps")) && numbered) {
    answer(motor.setSpeed(controlFor(number), motor.interval, magnitude(number)));
  } else if (is(word, F("speed")) || is(word, F("steps"))) {
    say(F("that needs a number, and not 0"));
  } else if (is(word, F("stop"))) {
    stop(motor);
    answer(0);
  } else if (is(word, F("hold"))) {
    answer(motor.hold());
  } else if (is(word, F("release"))) {
    answer(motor.release());
  } else if (is(word, F("ramp"))) {
    answer(motor.ramp());
  } else if (is(word, F("status"))) {
    printStatus(motor);
  } else {
    ask();
  }
}

// Does what the line says.
static void obeyLine() {
  const char *word = strtok(line, " ");
  const char *rest = strtok(nullptr, "");
  if (!word) return;
  if (is(word, F("help"))) {
    helpLeft = kHelp;
  } else {
    obey(motors[0], word, rest);
  }
}

void setup() {
  Serial.begin(115200);
  motorShieldInit();
  for (Motor &motor : motors) {
    stop(motor);  // from here on its status says that it is at rest
    motor.interval = motorTimerCalcPerSecond(200);
  }
  Serial.println(F("type help"));
}

void loop() {
  if (Serial.availableForWrite() < kRoom) return;  // the last line is still on its way
  if (helpLeft) {
    printHelpLine();
  } else if (readLine()) {
    obeyLine();
  }
}
