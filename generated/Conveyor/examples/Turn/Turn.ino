// Turns belt to and fro while the sketch goes on doing something else.

#include <Conveyor.h>

void setup() {
  beltShieldInit();
}

// One turn one way, then back, each time the last one has ended.
static void turnBelt() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(beltReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  beltSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, beltStepsForTurns(1));
}

void loop() {
  beltKeepAlive();  // or it stops after 500 ms
  turnBelt();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
