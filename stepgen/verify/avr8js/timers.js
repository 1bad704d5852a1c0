// What stepgen puts right around the timers of avr8js.
"use strict";

// The prescaler is shared and runs freely: ticks fall on multiples of it since reset.
function letPrescalerRun(cpu, timer) {
  const count = timer.count;
  timer.count = (reschedule, external) => {
    const changes = timer.updateDivider;
    count(reschedule, external);
    if (!changes || !timer.divider) return;
    timer.lastCycle = cpu.cycles - (cpu.cycles % timer.divider);
    cpu.updateClockEvent(timer.count, timer.lastCycle + timer.divider - cpu.cycles);
  };
}

// Cycles of the instruction at PC up to and with its I/O access: in, out, sbic and sbis take
// one; lds, sts, ld, st, sbi and cbi take two.
function accessCycles(cpu) {
  const opcode = cpu.progMem[cpu.pc];
  return (opcode & 0xf000) === 0xb000 || (opcode & 0xfd00) === 0x9900 ? 1 : 2;
}

// The timer counts up to the cycle of the access, not only to the start of its instruction.
function accessInTime(cpu, timer) {
  const { config } = timer;
  const countTo = (cyclesAhead) => {
    cpu.cycles += cyclesAhead;
    timer.count(false);
    cpu.cycles -= cyclesAhead;
  };
  const addresses = ["TCCRA", "TCCRB", "TCNT", "OCRA", "OCRB", "OCRC", "ICR", "TIFR"]
    .map((name) => config[name])
    .filter((address) => address);
  for (const address of addresses) {
    const own = cpu.writeHooks[address];
    cpu.writeHooks[address] = (...access) => {
      countTo(accessCycles(cpu));
      return own(...access);
    };
  }
  const read = cpu.readHooks[config.TCNT];
  cpu.readHooks[config.TCNT] = (address) => {
    countTo(accessCycles(cpu) - 1);
    return read(address);
  };
}

// A one clears its own flag; the others stay, with sbi too.
function clearOnlyWrittenFlags(cpu, { config: { TIFR } }) {
  const own = cpu.writeHooks[TIFR];
  cpu.writeHooks[TIFR] = (value, old, at, mask) => {
    const kept = cpu.data[TIFR] & ~(value & mask);
    own(value & mask, old, at, mask);
    cpu.data[TIFR] = kept;
    return true;
  };
}

// The edge at which a flag that is being set came, from what the timer has counted since.
function raiseEdge(interrupt, timer) {
  const { divider, lastCycle, tcnt, TOP } = timer;
  const at = {
    [timer.OCFA.flagMask]: timer.ocrA,
    [timer.OCFB.flagMask]: timer.ocrB,
    [timer.OCFC.flagMask]: timer.ocrC,
    [timer.OVF.flagMask]: 0,
  };
  const ticks = (tcnt - at[interrupt.flagMask] + TOP + 1) % (TOP + 1);
  return lastCycle - ticks * divider;
}

module.exports = { accessCycles, accessInTime, clearOnlyWrittenFlags, letPrescalerRun, raiseEdge };
