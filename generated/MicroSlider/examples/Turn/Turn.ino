// Turns carriage and head to and fro while the sketch goes on doing something else.

#include <MicroSlider.h>

void setup() {
  carriageShieldInit();
  headShieldInit();
}

// 200 steps one way, then back, each time the last one has ended.
static void turnCarriage() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(carriageReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  carriageSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, 200);
}

// One turn one way, then back, each time the last one has ended.
static void turnHead() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(headReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  headSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, headStepsForTurns(1));
}

void loop() {
  turnCarriage();
  turnHead();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
