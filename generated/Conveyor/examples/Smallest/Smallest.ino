// The smallest sketch: belt from the start, for ever.

#include <Conveyor.h>

void setup() {
  beltShieldInit();
  beltSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {}  // free for anything: the timer makes the steps
