// motor by hand: open the Serial Monitor at 115200 baud, line ending "Newline", and type help.
//
// The motor turns while the sketch reads and answers; nothing in it waits.
// The spec's `uses` does not name Serial: the highest rate is proven without its interrupts. Name
// it there before going to that limit.

#include <SlowMotor.h>

static const char kHelp[] PROGMEM =
    "speed 500    turn at 500 steps/s, backward with -500\n"
    "steps 2000   make 2000 steps at that speed, or -2000\n"
    "stop         at once, coils off\n"
    "hold         coils on, while it stands\n"
    "release      coils off, while it stands\n"
    "status       does it run, and where is it\n";

constexpr int kRoom = 62;  // no line that is printed is longer; the core has room for more

static char line[64];                   // what was typed; more than fits is cut off
static const char *helpLeft = nullptr;  // what of the help is still to be printed
static uint32_t interval;               // I/O clocks between two steps of the next motion

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

// Reads a whole number that is not 0; tells whether there is one and nothing else.
static bool readNumber(const char *text, int32_t &number) {
  if (!text) return false;
  char *end;
  number = strtol(text, &end, 10);
  return end != text && *end == '\0' && number != 0;
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

// Says what the library answered.
static void answer(int8_t result) {
  if (result == MOTOR_ERROR_TOO_FAST) {
    Serial.print(F("too fast: at most "));
    Serial.println(F_CPU / MOTOR_MIN_TOP);
  } else if (result == MOTOR_ERROR_RUNNING) {
    Serial.println(F("not while it runs"));
  } else {
    Serial.println(result ? F("refused") : F("ok"));
  }
}

// Turns at that speed until something else is asked for.
static int8_t turn(int32_t speed) {
  const int8_t result = motorSetSpeed(controlFor(speed), intervalFor(speed));
  if (result == 0) interval = intervalFor(speed);
  return result;
}

// Makes so many steps.
static int8_t go(int32_t steps) {
  return motorSetSpeed(controlFor(steps), interval, magnitude(steps));
}

// Says whether the motor runs, and where it is.
static void printStatus() {
  const bool rests = motorReadStatus() & MOTOR_STAT_REACHED;
  Serial.print(rests ? F("at rest, at step ") : F("running, at step "));
  Serial.println(motorReadPosition());
}

// Does what the line says.
static void obey() {
  const char *word = strtok(line, " ");
  const char *rest = strtok(nullptr, "");
  int32_t number = 0;
  const bool numbered = readNumber(rest, number);
  if (!word) return;
  if (is(word, F("speed")) && numbered) {
    answer(turn(number));
  } else if (is(word, F("steps")) && numbered) {
    answer(go(number));
  } else if (is(word, F("speed")) || is(word, F("steps"))) {
    Serial.println(F("that needs a number, and not 0"));
  } else if (is(word, F("stop"))) {
    answer(motorSetSpeed());
  } else if (is(word, F("hold"))) {
    answer(motorHold());
  } else if (is(word, F("release"))) {
    answer(motorRelease());
  } else if (is(word, F("status"))) {
    printStatus();
  } else if (is(word, F("help"))) {
    helpLeft = kHelp;
  } else {
    Serial.println(F("what? type help"));
  }
}

void setup() {
  Serial.begin(115200);
  motorShieldInit();
  motorSetSpeed();  // stopped: from here on its status says that it is at rest
  interval = motorTimerCalcPerSecond(200);
  Serial.println(F("type help"));
}

void loop() {
  if (Serial.availableForWrite() < kRoom) return;  // the last line is still on its way
  if (helpLeft) {
    printHelpLine();
  } else if (readLine()) {
    obey();
  }
}
