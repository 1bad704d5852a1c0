// The smallest sketch: x and y and z from the start, for ever.

#include <CompareThree.h>

void setup() {
  xShieldInit();
  yShieldInit();
  zShieldInit();
  xSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
  ySetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
  zSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {}  // free for anything: the timer makes the steps
