// Turns left and right to and fro while the sketch goes on doing something else.

#include <RadioCart.h>

void setup() {
  leftShieldInit();
  rightShieldInit();
}

// 200 steps one way, then back, each time the last one has ended.
static void turnLeft() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(leftReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  leftSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, 200);
}

// 200 steps one way, then back, each time the last one has ended.
static void turnRight() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(rightReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  rightSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, 200);
}

void loop() {
  leftKeepAlive();  // or it stops after 200 ms
  rightKeepAlive();  // or it stops after 40 ms
  turnLeft();
  turnRight();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
