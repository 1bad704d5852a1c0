// Turns pan and tilt to and fro while the sketch goes on doing something else.

#include <PanTilt.h>

void setup() {
  panShieldInit();
  tiltShieldInit();
}

// One turn one way, then back, each time the last one has ended.
static void turnPan() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(panReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  panSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, panStepsForTurns(1));
}

// One turn one way, then back, each time the last one has ended.
static void turnTilt() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(tiltReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  tiltSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, tiltStepsForTurns(1));
}

void loop() {
  turnPan();
  turnTilt();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
