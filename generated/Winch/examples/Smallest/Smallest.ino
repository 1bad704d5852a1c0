// The smallest sketch: drum from the start, for ever.

#include <Winch.h>

void setup() {
  drumShieldInit();
  drumSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
  motorWatchdogStart();  // from here on loop() has to feed it
}

void loop() {
  motorWatchdogFeed();  // or the chip resets after 250 ms
  drumKeepAlive();  // or it stops after 1000 ms
  // Free for anything that is soon over: the timer makes the steps.
}
