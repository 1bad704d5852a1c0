// motor beside Servo, which the spec names in `uses`: ten times a second the sketch does something
// small with it.

#include <ServoBeside.h>
#include <Servo.h>  // from the library manager

static Servo servoD2;

void setup() {
  motorShieldInit();
  servoD2.attach(2);
  motorSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {
  static uint16_t last = 0;
  static uint8_t count = 0;
  const uint16_t now = millis();
  if (static_cast<uint16_t>(now - last) < 100) return;
  last += 100;
  count++;
  servoD2.write(count & 16 ? 60 : 120);
}
