// The smallest sketch: slide from the start, for ever.

#include <Gentle.h>

void setup() {
  slideInit();
  slideRunForward();
}

void loop() {}  // free for anything: the timer makes the steps
