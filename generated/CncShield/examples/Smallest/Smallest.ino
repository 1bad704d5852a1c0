// The smallest sketch: x and y from the start, for ever.

#include <CncShield.h>

void setup() {
  xShieldInit();
  yShieldInit();
  xSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
  ySetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {}  // free for anything: the timer makes the steps
