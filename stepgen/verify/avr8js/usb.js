// What the chip's USB does beside a computer that opens no port; avr8js has no USB. The PLL locks
// at once. When the board has attached, the computer resets the bus, and begins a frame each
// millisecond.
"use strict";

const PLOCK = 1, PLLE = 2;  // bits of PLLCSR
const DETACH = 1;  // of UDCON
const SOFI = 1 << 2, EORSTI = 1 << 3;  // of UDINT and UDIEN

function plugIn(cpu, { PLLCSR, UDCON, UDINT, UDIEN, interrupt }, fCpuHz, hookWrite) {
  const request = { address: interrupt, enableRegister: 0, enableMask: 0, flagRegister: UDINT, flagMask: 0,
                    constant: true };
  const look = () => {
    if (cpu.data[UDINT] & cpu.data[UDIEN]) cpu.queueInterrupt(request);
    else cpu.clearInterrupt(request, false);
  };
  const raise = (flag) => {
    cpu.data[UDINT] |= flag;
    look();
  };
  let due = 0;  // the cycle of the next frame; 0 until the board has attached
  const awaitFrame = () => {
    due += fCpuHz / 1000;
    cpu.addClockEvent(() => {
      raise(SOFI);
      awaitFrame();
    }, due - cpu.cycles);
  };
  cpu.data[UDCON] = DETACH;
  hookWrite(PLLCSR, (value) => { cpu.data[PLLCSR] = (value & ~PLOCK) | (value & PLLE ? PLOCK : 0); });
  hookWrite(UDINT, look);
  hookWrite(UDIEN, look);
  hookWrite(UDCON, (value) => {
    if (due || value & DETACH) return;
    due = cpu.cycles;
    raise(EORSTI);
    awaitFrame();
  });
}

module.exports = { plugIn };
