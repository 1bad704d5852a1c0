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
  const addresses = ["TCCRA", "TCCRB", "TCCRC", "TCNT", "OCRA", "OCRB", "OCRC", "ICR", "TIFR"]
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

// Channel C, too, no longer waits once its flag or its enable bit is cleared.
function clearChannelC(cpu, { OCFC, config: { OCRC, TIFR, TIMSK } }) {
  if (!OCRC) return;
  const clear = cpu.writeHooks[TIFR], enable = cpu.writeHooks[TIMSK];
  cpu.writeHooks[TIFR] = (value, old, at, mask) => {
    cpu.clearInterruptByFlag(OCFC, value & mask);
    return clear(value, old, at, mask);
  };
  cpu.writeHooks[TIMSK] = (value, ...access) => {
    cpu.updateInterruptEnable(OCFC, value);
    return enable(value, ...access);
  };
}

// Beyond TOP the counter goes on to MAX; avr8js takes it back at once.
function countOnToMax(timer) {
  const { get } = Object.getOwnPropertyDescriptor(Object.getPrototypeOf(timer), "TOP");
  Object.defineProperty(timer, "TOP", {
    get() {
      const top = get.call(this);
      return this.tcnt > top ? this.MAX : top;
    },
  });
}

// Ticks from *count* until it comes again.
function lapFrom(count, { TOP, MAX }) {
  return (count > TOP ? MAX : TOP) + 1;
}

// A compare unit acts at the tick that leaves OCRnx, where avr8js acts at the one that gets there;
// and not at the first tick after a write to TCNTn.
function compareWhenLeft(cpu, timer) {
  const { TCNT } = timer.config;
  const write = cpu.writeHooks[TCNT];
  let blocked = false;
  cpu.writeHooks[TCNT] = (...access) => {
    const done = write(...access);
    blocked = true;
    return done;
  };
  const compare = timer.timerUpdated.bind(timer);
  timer.timerUpdated = (now, before) => {
    if (now === before) return;  // no tick: avr8js asks at a write to TCNTn, too
    const oneLess = (count) => (count || lapFrom(before, timer)) - 1;
    compare(oneLess(now), blocked ? before : oneLess(before));
    blocked = false;
  };
}

// The edge at which a flag that is being set came, from what the timer has counted since.
function raiseEdge(interrupt, timer, correct) {
  const { divider, lastCycle, tcnt } = timer;
  const match = {
    [timer.OCFA.flagMask]: timer.ocrA,
    [timer.OCFB.flagMask]: timer.ocrB,
    [timer.OCFC.flagMask]: timer.ocrC,
  }[interrupt.flagMask];
  const count = match ?? 0;
  const left = correct && match !== undefined ? 1 : 0;
  const lap = lapFrom(count, timer);
  return lastCycle - ((tcnt - count - left + lap) % lap) * divider;
}

module.exports = {
  accessCycles, accessInTime, clearChannelC, clearOnlyWrittenFlags, compareWhenLeft, countOnToMax,
  letPrescalerRun, raiseEdge,
};
