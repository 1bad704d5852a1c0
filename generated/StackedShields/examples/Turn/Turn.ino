// Turns lower and upper to and fro while the sketch goes on doing something else.

#include <StackedShields.h>

void setup() {
  lowerShieldInit();
  upperShieldInit();
}

// One turn one way, then back, each time the last one has ended.
static void turnLower() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(lowerReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  lowerSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, lowerStepsForTurns(1));
}

// One turn one way, then back, each time the last one has ended.
static void turnUpper() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(upperReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  upperSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, upperStepsForTurns(1));
}

void loop() {
  turnLower();
  turnUpper();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
