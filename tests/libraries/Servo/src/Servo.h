// Stands for the Servo library, which comes from Arduino's library manager, so that examples that
// use it compile: the same functions, and nothing behind them.
#pragma once

#include <stdint.h>

class Servo {
 public:
  uint8_t attach(int pin) { return pin; }
  void write(int angle) { angle_ = angle; }

 private:
  volatile int angle_ = 0;
};
