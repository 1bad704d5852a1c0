// carriage and head beside Serial, Serial1 and Wire, which the spec names in `uses`: ten times a
// second the sketch does something small with each.

#include <MicroSlider.h>
#include <Wire.h>

constexpr uint8_t kDevice = 0x20;  // the address of a PCF8574, for example

void setup() {
  carriageShieldInit();
  headShieldInit();
  Serial.begin(115200);
  Serial1.begin(115200);
  Wire.begin();
  Wire.setWireTimeout(3000);  // us: nothing hangs if the bus does
  carriageSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
  headSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(200));  // steps/s
}

void loop() {
  static uint16_t last = 0;
  static uint8_t count = 0;
  const uint16_t now = millis();
  if (static_cast<uint16_t>(now - last) < 100) return;
  last += 100;
  count++;
  Serial.println(carriageReadPosition());
  Serial1.println(carriageReadPosition());
  Wire.beginTransmission(kDevice);
  Wire.write(count);
  Wire.endTransmission();
}
