// motor beside Servo and Serial, which the spec names in `uses`: ten times a second the sketch does
// something small with each.

#include <ServoVariable.h>
#include <Servo.h>  // from the library manager

static Servo servoD9;
static Servo servoD10;

void setup() {
  motorShieldInit();
  servoD9.attach(9);
  servoD10.attach(10);
  Serial.begin(115200);
  motorSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {
  static uint16_t last = 0;
  static uint8_t count = 0;
  const uint16_t now = millis();
  if (static_cast<uint16_t>(now - last) < 100) return;
  last += 100;
  count++;
  servoD9.write(count & 16 ? 60 : 120);
  servoD10.write(count & 16 ? 60 : 120);
  Serial.println(motorReadPosition());
}
