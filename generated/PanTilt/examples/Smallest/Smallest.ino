// The smallest sketch: pan and tilt from the start, for ever.

#include <PanTilt.h>

void setup() {
  panShieldInit();
  tiltShieldInit();
  panSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
  tiltSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {}  // free for anything: the timer makes the steps
