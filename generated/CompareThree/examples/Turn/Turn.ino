// Turns x and y and z to and fro while the sketch goes on doing something else.

#include <CompareThree.h>

void setup() {
  xShieldInit();
  yShieldInit();
  zShieldInit();
}

// 200 steps one way, then back, each time the last one has ended.
static void turnX() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(xReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  xSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, 200);
}

// 200 steps one way, then back, each time the last one has ended.
static void turnY() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(yReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  ySetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, 200);
}

// 200 steps one way, then back, each time the last one has ended.
static void turnZ() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(zReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  zSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, 200);
}

void loop() {
  turnX();
  turnY();
  turnZ();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
