// The smallest sketch: carriage and head from the start, for ever.

#include <MicroSlider.h>

void setup() {
  carriageShieldInit();
  headShieldInit();
  carriageSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
  headSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {}  // free for anything: the timer makes the steps
