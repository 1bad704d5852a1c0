// The smallest sketch: slide from the start, for ever.

#include <HomingSlide.h>

void setup() {
  slideInit();
  slideRunForward();
}

void loop() {}  // free for anything: the timer makes the steps
