// The smallest sketch: x and y and z from the start, for ever or to the end of its range.

#include <RampsLimits.h>

void setup() {
  xInit();
  yInit();
  zInit();
  xRunForward();
  yRunForward();
  zRunForward();
}

void loop() {}  // free for anything: the timer makes the steps
