// The smallest sketch: lower and upper from the start, for ever.

#include <TwoShields.h>

void setup() {
  lowerShieldInit();
  upperShieldInit();
  lowerSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
  upperSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {}  // free for anything: the timer makes the steps
