// Turns motor to and fro while the sketch goes on doing something else.

#include <SlowMotor.h>

void setup() {
  motorShieldInit();
}

// One turn one way, then back, each time the last one has ended.
static void turnMotor() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(motorReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  motorSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, motorStepsForTurns(1));
}

void loop() {
  turnMotor();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
