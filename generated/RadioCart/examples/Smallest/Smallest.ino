// The smallest sketch: left and right from the start, for ever.

#include <RadioCart.h>

void setup() {
  leftShieldInit();
  rightShieldInit();
  leftSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
  rightSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {
  leftKeepAlive();  // or it stops after 200 ms
  rightKeepAlive();  // or it stops after 40 ms
  // Free for anything that is soon over: the timer makes the steps.
}
