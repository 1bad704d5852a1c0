// The smallest sketch: z from the start, for ever.

#include <RampsZ.h>

void setup() {
  zShieldInit();
  zSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {}  // free for anything: the timer makes the steps
