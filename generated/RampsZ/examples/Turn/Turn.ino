// Turns z to and fro while the sketch goes on doing something else.

#include <RampsZ.h>

void setup() {
  zShieldInit();
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
  turnZ();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
