// Looks for home first, and then moves slide to and fro. Open the Serial Monitor at 115200 baud:
// the sketch says that it is there, or what went wrong.

#include <HomingSlide.h>

// What has stopped a motor, by its fault.
static const __FlashStringHelper *reason(uint8_t fault) {
  switch (fault) {
    case MOTOR_FAULT_LIMIT: return F(" stopped at a limit switch");
    case MOTOR_FAULT_HOMING: return F(" has not found its switch, or that stays pressed");
    case MOTOR_FAULT_EMERGENCY: return F(" stopped in an emergency");
    default: return F("");
  }
}

// The places between which slide goes, in steps: the ends of its range.
constexpr int32_t kSlideNear = 0;
constexpr int32_t kSlideFar = 14400;

// The next way of slide, unless it is under way; says so once if something has stopped it.
static void moveSlide() {
  static uint8_t fault = 0;
  if (slideIsRunning() || fault) return;
  fault = slideReadFault();
  if (fault) {
    Serial.print(F("slide"));
    Serial.println(reason(fault));
    return;
  }
  const bool isFar = slideCurrentPosition() == kSlideFar;
  slideMoveTo(isFar ? kSlideNear : kSlideFar);
}

void setup() {
  Serial.begin(115200);
  slideInit();
  slideHome();
  while (slideIsRunning()) {}
  if (slideIsHomed()) Serial.println(F("slide is home"));
}

void loop() {
  moveSlide();
}
