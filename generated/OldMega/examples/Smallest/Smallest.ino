// The smallest sketch: near and far from the start, for ever.

#include <OldMega.h>

void setup() {
  nearShieldInit();
  farShieldInit();
  nearSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
  farSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {}  // free for anything: the timer makes the steps
