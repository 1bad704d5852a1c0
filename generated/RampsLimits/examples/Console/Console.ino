// x, y and z by hand: open the Serial Monitor at 115200 baud, line ending "Newline", and type help.
//
// The sketch reads and answers while they move; nothing in it waits.
// The spec's `uses` does not name Serial: the highest rate is proven without its interrupts. Name
// it there before going to that limit.

#include <RampsLimits.h>

static const char kHelp[] PROGMEM =
    "AXIS to 2000      move to that position\n"
    "AXIS move -2000   so many steps from here\n"
    "AXIS speed 500    cruise at 500 steps/s from now on\n"
    "AXIS run          forward as far as it may; back: backward\n"
    "AXIS stop         slow down to rest; halt: at once\n"
    "AXIS zero         call this place 0, while it stands\n"
    "AXIS home         look for the limit switch\n"
    "AXIS fault        why it moves no more\n"
    "AXIS clear        let it move again\n"
    "AXIS on           coils on, while it stands\n"
    "AXIS off          coils off, while it stands\n"
    "AXIS status       does it run, and where is it\n"
    "stop, status       the same of all\n"
    "AXIS is x\n"
    "AXIS is y\n"
    "AXIS is z\n";

// What can be asked of a motor with ramps.
struct Axis {
  const char *name;
  int8_t (*moveTo)(int32_t target);
  int8_t (*move)(int32_t steps);
  int8_t (*setSpeed)(uint32_t interval);
  int8_t (*runForward)();
  int8_t (*runBackward)();
  void (*stop)();
  void (*halt)();
  int8_t (*setPosition)(int32_t position);
  int32_t (*position)();
  bool (*isRunning)();
  int8_t (*home)();  // null where there is none
  uint8_t (*fault)();
  void (*clear)();
  int8_t (*on)();
  int8_t (*off)();
};

static const Axis axes[] = {
    {"x",
     xMoveTo, xMove, xSetSpeed, xRunForward, xRunBackward, xStop, xHalt, xSetCurrentPosition,
     xCurrentPosition, xIsRunning, xHome, xReadFault, xClearFault, xEnableOutputs,
     xDisableOutputs},
    {"y",
     yMoveTo, yMove, ySetSpeed, yRunForward, yRunBackward, yStop, yHalt, ySetCurrentPosition,
     yCurrentPosition, yIsRunning, nullptr, yReadFault, yClearFault, yEnableOutputs,
     yDisableOutputs},
    {"z",
     zMoveTo, zMove, zSetSpeed, zRunForward, zRunBackward, zStop, zHalt, zSetCurrentPosition,
     zCurrentPosition, zIsRunning, nullptr, zReadFault, zClearFault, zEnableOutputs,
     zDisableOutputs},
};

constexpr int kRoom = 62;  // no line that is printed is longer; the core has room for more

static char line[64];                   // what was typed; more than fits is cut off
static const char *helpLeft = nullptr;  // what of the help is still to be printed
constexpr uint8_t kMotors = 3;
static uint8_t shown = kMotors;         // the motor whose status is printed next, or past all

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
    case MOTOR_ERROR_RANGE: return say(F("that is beyond its range"));
    case MOTOR_ERROR_HOMING: return say(F("not while it looks for home"));
    case MOTOR_ERROR_FAULT: return say(F("not until you clear the fault"));
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

// Cruises at that speed from now on.
static void cruise(const Axis &axis, int32_t speed) {
  const int8_t result = axis.setSpeed(speed > 0 ? motorInterval(speed) : 0);
  if (result == MOTOR_ERROR_TOO_FAST) {
    say(F("that is no speed, or faster than the spec's"));
  } else {
    answer(result);
  }
}

// Does what has a result, and what has none.
static void act(int8_t (*function)()) {
  answer(function());
}

static void act(void (*function)()) {
  function();
  answer(0);
}

// Says why a motor moves no more.
static void tell(uint8_t (*readFault)()) {
  switch (readFault()) {
    case MOTOR_FAULT_LIMIT: return say(F("stopped at a limit switch"));
    case MOTOR_FAULT_HOMING: return say(F("has not found its switch, or that stays pressed"));
    case MOTOR_FAULT_EMERGENCY: return say(F("stopped in an emergency"));
    default: return say(F("no fault"));
  }
}

static void stop(const Axis &axis) {
  axis.stop();
}

static void printStatus(const Axis &axis) {
  printPosition(axis.name, axis.isRunning(), axis.position());
}

// Does what needs a number; tells whether the word is such a one.
static bool obeyNumber(const Axis &axis, const char *word, int32_t number) {
  if (is(word, F("to"))) {
    answer(axis.moveTo(number));
  } else if (is(word, F("move"))) {
    answer(axis.move(number));
  } else if (is(word, F("speed"))) {
    cruise(axis, number);
  } else {
    return false;
  }
  return true;
}

// Does what the words say.
static void obey(const Axis &axis, const char *word, const char *rest) {
  int32_t number = 0;
  if (readNumber(rest, number) && obeyNumber(axis, word, number)) return;
  if (is(word, F("run"))) {
    act(axis.runForward);
  } else if (is(word, F("back"))) {
    act(axis.runBackward);
  } else if (is(word, F("stop"))) {
    stop(axis);
    answer(0);
  } else if (is(word, F("halt"))) {
    act(axis.halt);
  } else if (is(word, F("zero"))) {
    answer(axis.setPosition(0));
  } else if (is(word, F("home")) && axis.home) {
    act(axis.home);
  } else if (is(word, F("fault"))) {
    tell(axis.fault);
  } else if (is(word, F("clear"))) {
    act(axis.clear);
  } else if (is(word, F("on"))) {
    act(axis.on);
  } else if (is(word, F("off"))) {
    act(axis.off);
  } else if (is(word, F("status"))) {
    printStatus(axis);
  } else {
    ask();
  }
}

// Stops every motor.
static void stopAll() {
  for (const Axis &motor : axes) stop(motor);
}

// Says how the next motor is.
static void printNextStatus() {
  switch (shown++) {
    case 0: return printStatus(axes[0]);
    case 1: return printStatus(axes[1]);
    case 2: return printStatus(axes[2]);
  }
}

// Does what the line says.
static void obeyLine() {
  const char *first = strtok(line, " ");
  const char *word = strtok(nullptr, " ");
  const char *rest = strtok(nullptr, "");
  if (!first) return;
  for (const Axis &motor : axes) {
    if (word && strcmp(first, motor.name) == 0) return obey(motor, word, rest);
  }
  if (is(first, F("stop")) && !word) {
    stopAll();
    answer(0);
  } else if (is(first, F("status")) && !word) {
    shown = 0;
  } else if (is(first, F("help")) && !word) {
    helpLeft = kHelp;
  } else {
    ask();
  }
}

void setup() {
  Serial.begin(115200);
  xInit();
  yInit();
  zInit();
  Serial.println(F("type help"));
}

void loop() {
  if (Serial.availableForWrite() < kRoom) return;  // the last line is still on its way
  if (helpLeft) {
    printHelpLine();
  } else if (shown < kMotors) {
    printNextStatus();
  } else if (readLine()) {
    obeyLine();
  }
}
