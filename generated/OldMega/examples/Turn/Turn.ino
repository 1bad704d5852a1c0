// Turns near and far to and fro while the sketch goes on doing something else.

#include <OldMega.h>

void setup() {
  nearShieldInit();
  farShieldInit();
}

// One turn one way, then back, each time the last one has ended.
static void turnNear() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(nearReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  nearSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, nearStepsForTurns(1));
}

// 200 steps one way, then back, each time the last one has ended.
static void turnFar() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(farReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  farSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, 200);
}

void loop() {
  turnNear();
  turnFar();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
