// Turns left and right to and fro while the sketch goes on doing something else.

#include <CompareTwo.h>

void setup() {
  leftShieldInit();
  rightShieldInit();
}

// One turn one way, then back, each time the last one has ended.
static void turnLeft() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(leftReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  leftSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, leftStepsForTurns(1));
}

// One turn one way, then back, each time the last one has ended.
static void turnRight() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(rightReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  rightSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, rightStepsForTurns(1));
}

void loop() {
  turnLeft();
  turnRight();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
