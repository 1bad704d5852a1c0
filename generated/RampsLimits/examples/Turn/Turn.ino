// Turns x and y and z to and fro while the sketch goes on doing something else.

#include <RampsLimits.h>

void setup() {
  xInit();
  yInit();
  zInit();
}

// 200 steps one way, then back, each time the last one has ended.
static void turnX() {
  if (xIsRunning()) return;
  const int32_t there = 200;
  xMoveTo(xCurrentPosition() == there ? 0 : there);
}

// 200 steps one way, then back, each time the last one has ended.
static void turnY() {
  if (yIsRunning()) return;
  const int32_t there = 200;
  yMoveTo(yCurrentPosition() == there ? 0 : there);
}

// One turn one way, then back, each time the last one has ended.
static void turnZ() {
  if (zIsRunning()) return;
  const int32_t there = zStepsForTurns(1);
  zMoveTo(zCurrentPosition() == there ? 0 : there);
}

void loop() {
  turnX();
  turnY();
  turnZ();
  // Whatever else the sketch has to do goes here: no step waits for it.
}
