// Turns drum to and fro while the sketch goes on doing something else.

#include <Winch.h>

void setup() {
  drumShieldInit();
  motorWatchdogStart();  // from here on loop() has to feed it
}

// One turn one way, then back, each time the last one has ended.
static void turnDrum() {
  static uint8_t direction = MOTOR_CTRL_DIRECTION;
  static bool started = false;
  if (started && !(drumReadStatus() & MOTOR_STAT_REACHED)) return;
  started = true;
  direction ^= MOTOR_CTRL_DIRECTION;
  const uint32_t interval = motorTimerCalcPerSecond(200);  // steps per second
  drumSetSpeed(MOTOR_CTRL_DRV_EN | direction, interval, drumStepsForTurns(1));
}

void loop() {
  motorWatchdogFeed();  // or the chip resets after 250 ms
  drumKeepAlive();  // or it stops after 1000 ms
  turnDrum();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
