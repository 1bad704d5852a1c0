// Looks for home first, and then moves x to and fro. Open the Serial Monitor at 115200 baud: the
// sketch says that it is there, or what went wrong.

#include <RampsLimits.h>

// What has stopped a motor, by its fault.
static const __FlashStringHelper *reason(uint8_t fault) {
  switch (fault) {
    case MOTOR_FAULT_LIMIT: return F(" stopped at a limit switch");
    case MOTOR_FAULT_HOMING: return F(" has not found its switch, or that stays pressed");
    case MOTOR_FAULT_EMERGENCY: return F(" stopped in an emergency");
    default: return F("");
  }
}

// The places between which x goes, in steps: at home, and 200 steps from there.
constexpr int32_t kXNear = 16000;
constexpr int32_t kXFar = 15800;

// The next way of x, unless it is under way; says so once if something has stopped it.
static void moveX() {
  static uint8_t fault = 0;
  if (xIsRunning() || fault) return;
  fault = xReadFault();
  if (fault) {
    Serial.print(F("x"));
    Serial.println(reason(fault));
    return;
  }
  const bool isFar = xCurrentPosition() == kXFar;
  xMoveTo(isFar ? kXNear : kXFar);
}

void setup() {
  Serial.begin(115200);
  xInit();
  yInit();
  zInit();
  xHome();
  while (xIsRunning()) {}
  if (xIsHomed()) Serial.println(F("x is home"));
}

void loop() {
  moveX();
}
