// The smallest sketch: slide from the start, to the end of its range.

#include <HomingSlide.h>

void setup() {
  slideInit();
  slideRunForward();
}

void loop() {}  // free for anything: the timer makes the steps
