// motor beside Serial and tone, which the spec names in `uses`: ten times a second the sketch does
// something small with each.

#include <LeonardoShield.h>

void setup() {
  motorShieldInit();
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
  Serial.println(motorReadPosition());
  if (count % 16 == 0) tone(4, 440, 50);  // Hz, ms
}
