// The smallest sketch: left and right from the start, for ever.

#include <CompareTwo.h>

void setup() {
  leftShieldInit();
  rightShieldInit();
  leftSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
  rightSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {}  // free for anything: the timer makes the steps
