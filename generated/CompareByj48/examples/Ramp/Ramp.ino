// Update events: the speed of motor goes up and down by itself.

#include <CompareByj48.h>

void setup() {
  motorShieldInit();
  motorSetSpeed();  // stopped: from here on its status says that it is at rest
}

// Begins the next ramp of motor when no event of the last one is left: up, down, up, and so on.
static void rampMotor() {
  static bool faster = false;
  const uint8_t status = motorReadStatus();
  if (!(status & (MOTOR_STAT_REACHED | MOTOR_STAT_SPIN_FIXED))) return;  // events are left
  faster = !faster;
  // 60 events, one each 50 ms: the step interrupt applies them (IRQ_TIMING). Each changes
  // the interval between two steps by 2000 I/O clocks.
  const uint8_t control = MOTOR_CTRL_SPEED_VARIABLE | MOTOR_CTRL_IRQ_TIMING | MOTOR_CTRL_DRV_EN;
  if (faster) {
    // From 100 steps/s, 160000 clocks, to 400 steps/s.
    motorSetSpeed(control | MOTOR_CTRL_FASTER, 160000UL, 0, 2000UL, 50, 60);
  } else {
    // From 400 steps/s, 40000 clocks, to 100 steps/s.
    motorSetSpeed(control | MOTOR_CTRL_SLOWER, 40000UL, 0, 2000UL, 50, 60);
  }
}

void loop() {
  rampMotor();
}
