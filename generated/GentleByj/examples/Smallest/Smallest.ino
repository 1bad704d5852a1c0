// The smallest sketch: motor and feed from the start, for ever.

#include <GentleByj.h>

void setup() {
  motorInit();
  feedShieldInit();
  motorRunForward();
  feedSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {}  // free for anything: the timer makes the steps
