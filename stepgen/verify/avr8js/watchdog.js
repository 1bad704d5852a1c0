// The watchdog is avr8js's own; what its reset does to the chip is put right here. On the chip every
// I/O register then has its initial value, and the watchdog is on, with its shortest time, until
// WDRF is cleared; avr8js leaves registers as they are, and lets WDE be cleared at once.
"use strict";

const { AVRWatchdog } = require(process.argv[2]);

const MCUSR = 0x54, WDTCSR = 0x60;
const PORF = 1, WDRF = 8;  // of MCUSR
const WDE = 8, WDCE = 16;  // of WDTCSR

// Gives *cpu* avr8js's watchdog as it is.
function addRawWatchdog(cpu, { interrupt, fCpuHz }) {
  new AVRWatchdog(cpu, { watchdogInterrupt: interrupt, MCUSR, WDTCSR }, { frequency: fCpuHz });
}

// Gives *cpu*, fresh from a reset by *causes*, a watchdog, whose reset calls *onReset*.
function addWatchdog(cpu, { interrupt, fCpuHz }, causes, onReset) {
  addRawWatchdog(cpu, { interrupt, fCpuHz });
  const own = cpu.writeHooks[WDTCSR];
  cpu.writeHooks[WDTCSR] = (value, old, at, mask) => {
    const kept = cpu.data[MCUSR] & WDRF ? WDE : 0;
    return own(value | kept, old, at, mask);
  };
  cpu.reset = onReset;
  cpu.data[MCUSR] = causes;
  if (causes & WDRF) for (const value of [WDE | WDCE, WDE]) cpu.writeData(WDTCSR, value);
}

module.exports = { MCUSR, PORF, WDRF, addRawWatchdog, addWatchdog };
