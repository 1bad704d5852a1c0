// Finds out in which order the four coils of a motor are wired. Open the Serial Monitor at 115200
// baud and answer its questions.
//
// A motor whose coils are switched in a wrong order trembles, or turns to and fro. There are 24
// orders, but the coils go round in a circle: where it begins makes no difference, and the other
// way round the motor just turns the other way. That leaves three to try, and then the direction.
//
// The sketch drives the pins itself, with digitalWrite(), one coil at a time, slowly, and waits in
// between. Of the library it uses nothing but its check that this is the right board.

#include <GentleByj.h>

constexpr uint16_t kSteps = 256;  // full steps of each try: an eighth of a turn of a 28BYJ-48
constexpr uint8_t kStepMillis = 10;

// A motor, its pins as the spec has them, and what they are called there.
struct Motor {
  const char *name;
  uint8_t pins[4];
  const char *labels[4];
};

static const Motor motors[] = {
    {"motor", {8, 9, 10, 11}, {"D8", "D9", "D10", "D11"}},
};

static const uint8_t kOrders[3][4] = { {0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 1, 3} };

// Which coil of four comes after so many steps, forward or backward.
static uint8_t phaseAfter(uint16_t steps, bool backward) {
  return (backward ? -steps : steps) & 3;
}

// Switches one coil after the other.
static void turn(const Motor &motor, const uint8_t order[4], bool backward) {
  for (uint16_t step = 0; step < kSteps; step++) {
    const uint8_t pin = motor.pins[order[phaseAfter(step, backward)]];
    digitalWrite(pin, HIGH);
    delay(kStepMillis);
    digitalWrite(pin, LOW);
  }
}

// Asks until one of *answers* is typed, and returns it. What was typed before counts for nothing.
static char ask(const __FlashStringHelper *question, const char *answers) {
  while (Serial.read() >= 0) {}
  Serial.println(question);
  for (;;) {
    const int letter = Serial.read();
    if (letter <= ' ') continue;  // nothing yet, or a line end
    if (strchr(answers, letter)) return letter;
    Serial.println(question);
  }
}

// Turns the motor in each order until one was smooth, and returns that.
static const uint8_t *findOrder(const Motor &motor) {
  for (;;) {
    for (uint8_t number = 0; number < 3; number++) {
      Serial.print(F("order "));
      Serial.println(number + 1);
      turn(motor, kOrders[number], false);
      delay(500);
    }
    const char answer = ask(F("Which one was smooth: 1, 2, 3? 0: none, r: once more"), "1230r");
    if (answer >= '1' && answer <= '3') return kOrders[answer - '1'];
    if (answer == '0') {
      Serial.println(F("A wire is loose, or one of the four goes to no coil."));
      ask(F("Check supply, common wire and plugs, then type r"), "r");
    }
  }
}

// Prints the pins as they belong into the spec.
static void printPins(const Motor &motor, const uint8_t order[4], bool backward) {
  Serial.print(F("  pins: ["));
  for (uint8_t coil = 0; coil < 4; coil++) {
    if (coil) Serial.print(F(", "));
    Serial.print(motor.labels[order[phaseAfter(coil, backward)]]);
  }
  Serial.println(']');
}

static void test(const Motor &motor) {
  Serial.print(F("motor "));
  Serial.println(motor.name);
  for (const uint8_t pin : motor.pins) pinMode(pin, OUTPUT);
  const uint8_t *order = findOrder(motor);
  Serial.println(F("once more"));
  turn(motor, order, false);
  const bool backward = ask(F("Was that forward for you: y or n?"), "yn") == 'n';
  if (order == kOrders[0] && !backward) {
    Serial.println(F("All is as the spec has it:"));
  } else {
    Serial.println(F("Write this into the spec, and generate the library again:"));
  }
  printPins(motor, order, backward);
}

void setup() {
  Serial.begin(115200);
  for (const Motor &motor : motors) test(motor);
  Serial.println(F("That is all; reset the board to begin again."));
}

void loop() {}
