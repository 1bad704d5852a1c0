// The smallest sketch: belt from the start, for ever.

#include <Conveyor.h>

void setup() {
  beltShieldInit();
  beltSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {
  beltKeepAlive();  // or it stops after 500 ms
  // Free for anything that is soon over: the timer makes the steps.
}
