// Turns motor and feed to and fro while the sketch goes on doing something else.

#include <GentleByj.h>

void setup() {
  motorInit();
  feedShieldInit();
}

// One turn one way, then back, each time the last one has ended.
static void turnMotor() {
  if (motorIsRunning()) return;
  const int32_t there = motorStepsForTurns(1);
  motorMoveTo(motorCurrentPosition() == there ? 0 : there);
}

// 200 steps one way, then back, each time the last one has ended.
static void turnFeed() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(feedReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  feedSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, 200);
}

void loop() {
  turnMotor();
  turnFeed();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
