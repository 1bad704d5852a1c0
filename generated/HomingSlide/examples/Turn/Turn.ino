// Turns slide to and fro while the sketch goes on doing something else.

#include <HomingSlide.h>

void setup() {
  slideInit();
}

// 200 steps one way, then back, each time the last one has ended.
static void turnSlide() {
  if (slideIsRunning()) return;
  const int32_t there = 200;
  slideMoveTo(slideCurrentPosition() == there ? 0 : there);
}

void loop() {
  turnSlide();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
