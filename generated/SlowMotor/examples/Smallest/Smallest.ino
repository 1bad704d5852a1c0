// The smallest sketch: motor from the start, for ever.

#include <SlowMotor.h>

void setup() {
  motorShieldInit();
  motorSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {}  // free for anything: the timer makes the steps
