// x and y and z by hand: open the Serial Monitor at 115200 baud, line ending "Newline", and
// type help.
//
// The motors move while the sketch reads and answers; nothing in it waits.
// The spec's `uses` does not name Serial: the highest rate is proven without its interrupts. Name
// it there before going to that limit.

#include <Axes.h>

static const char kHelp[] PROGMEM =
    "to 2000      move to that position\n"
    "move -2000   so many steps from here\n"
    "speed 500    cruise at 500 steps/s from now on\n"
    "run          forward without an end; back: backward\n"
    "stop         slow down to rest; halt: at once\n"
    "zero         call this place 0, while it stands\n"
    "on           coils on, while it stands; off: off\n"
    "status       does it run, and where is it\n"
    "x to 2000   the same of x\n"
    "y to 2000   the same of y\n"
    "z to 2000   the same of z\n"
    ;

// What can be asked of a motor.
struct Motor {
  const char *name;
  int8_t (*moveTo)(int32_t target);
  int8_t (*move)(int32_t steps);
  int8_t (*setSpeed)(uint32_t interval);
  void (*runForward)();
  void (*runBackward)();
  void (*stop)();
  void (*halt)();
  int8_t (*setPosition)(int32_t position);
  int32_t (*position)();
  bool (*isRunning)();
  int8_t (*enable)();   // null where nothing switches the current
  int8_t (*disable)();  // the same
};

static const Motor motors[] = {
    {"x", xMoveTo, xMove, xSetSpeed, xRunForward,
     xRunBackward, xStop, xHalt, xSetCurrentPosition,
     xCurrentPosition, xIsRunning, xEnableOutputs, xDisableOutputs},
    {"y", yMoveTo, yMove, ySetSpeed, yRunForward,
     yRunBackward, yStop, yHalt, ySetCurrentPosition,
     yCurrentPosition, yIsRunning, yEnableOutputs, yDisableOutputs},
    {"z", zMoveTo, zMove, zSetSpeed, zRunForward,
     zRunBackward, zStop, zHalt, zSetCurrentPosition,
     zCurrentPosition, zIsRunning, zEnableOutputs, zDisableOutputs},
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

// Says what the library answered.
static void answer(int8_t result) {
  if (result == MOTOR_ERROR_TOO_FAST) {
    Serial.println(F("that is no speed, or faster than the spec's"));
  } else if (result == MOTOR_ERROR_RUNNING) {
    Serial.println(F("not while it runs"));
  } else {
    Serial.println(F("ok"));
  }
}

// Does what has no result.
static void act(void (*function)()) {
  function();
  answer(0);
}

// Says whether a motor runs, and where it is.
static void printStatus(const Motor &motor) {
  Serial.print(motor.name);
  Serial.print(motor.isRunning() ? F(" running, at step ") : F(" at rest, at step "));
  Serial.println(motor.position());
}

// Does what needs a number; tells whether the word is such a one.
static bool obeyNumber(const Motor &motor, const char *word, int32_t number) {
  if (is(word, F("to"))) {
    answer(motor.moveTo(number));
  } else if (is(word, F("move"))) {
    answer(motor.move(number));
  } else if (is(word, F("speed"))) {
    answer(motor.setSpeed(number > 0 ? motorInterval(number) : 0));
  } else {
    return false;
  }
  return true;
}

// Does what the words behind the name of a motor say.
static void obey(const Motor &motor, const char *word, const char *rest) {
  int32_t number = 0;
  if (readNumber(rest, number) && obeyNumber(motor, word, number)) return;
  if (is(word, F("run"))) {
    act(motor.runForward);
  } else if (is(word, F("back"))) {
    act(motor.runBackward);
  } else if (is(word, F("stop"))) {
    act(motor.stop);
  } else if (is(word, F("halt"))) {
    act(motor.halt);
  } else if (is(word, F("zero"))) {
    answer(motor.setPosition(0));
  } else if (is(word, F("on")) && motor.enable) {
    answer(motor.enable());
  } else if (is(word, F("off")) && motor.disable) {
    answer(motor.disable());
  } else if (is(word, F("status"))) {
    printStatus(motor);
  } else {
    Serial.println(F("what? type help"));
  }
}

// Does what the line says; without the name of a motor, of the first one.
static void obeyLine() {
  const char *word = strtok(line, " ");
  if (!word) return;
  if (is(word, F("help"))) {
    helpLeft = kHelp;
    return;
  }
  const Motor *chosen = motors;
  for (const Motor &motor : motors) {
    if (strcmp(word, motor.name) != 0) continue;
    chosen = &motor;
    word = strtok(nullptr, " ");
    break;
  }
  const char *rest = strtok(nullptr, "");
  if (word) obey(*chosen, word, rest);
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
  } else if (readLine()) {
    obeyLine();
  }
}
