// One simulated chip that runs one program in avr8js, and what is recorded of it.
//
// The instructions, the timers, the ports and the UART are avr8js's own. What it leaves to its
// caller or does unlike the chip is put right here and in timers.js, unless the job says not to
// ("correct"): the interrupt response, waking up, the instruction after sei, and cbi, which takes
// two cycles.
"use strict";

const { CPU, AVRIOPort, AVRTimer, AVRUSART, avrInstruction } = require(process.argv[2]);
const {
  accessCycles, accessInTime, clearChannelC, clearOnlyWrittenFlags, compareWhenLeft, countOnToMax,
  letPrescalerRun, raiseEdge,
} = require("./timers.js");
const { plugIn } = require("./usb.js");
const { MCUSR, PORF, WDRF, addRawWatchdog, addWatchdog } = require("./watchdog.js");

const KIND = {
  PORT: 1, REGISTER: 2, MARK: 3, ISR_ENTER: 4, ISR_EXIT: 5, UART: 6, MASKED: 7, UNMASKED: 8, RAISE: 9,
  RESET: 10,
};
const EEDR = 0x40, SMCR = 0x53, SREG = 0x5f;
const I_FLAG = 0x80, SLEEP_ENABLE = 1, SLEEP_MODE = 0x0e;
const SLEEP = 0x9588, RETI = 0x9518;
const CBI_MASK = 0xff00, CBI = 0x9800;
const SERIAL_RETRY_CYCLES = 100;
const LIBRARY_RESPONSE = 2;  // cycles that avrInterrupt() takes
const WAKE_CYCLES = 4;
const WORDS_PER_VECTOR = 2;
const FIELDS = 6;
const REGISTERS = 0x100;  // what avr8js puts before the RAM that it is asked for

class Machine {
  constructor(job) {
    this.job = job;
    this.correct = job.correct;
    this.flash = new Uint16Array(job.flash_bytes / 2).fill(0xffff);
    new Uint8Array(this.flash.buffer).set(Buffer.from(job.image, "base64"));
    this.rows = [];
    this.serial = [];
    this.fine = false;
    this.wantedMark = -1;
    this.error = "";
    this.start(new CPU(this.flash, job.ram_end + 1 - REGISTERS), PORF);
  }

  // The chip as a reset leaves it, around a fresh *cpu*; MCUSR holds *causes*.
  start(cpu, causes) {
    const { job } = this;
    this.cpu = cpu;
    this.frames = [];
    this.raisedAt = {};
    this.enabledAt = {};
    this.unmaskedAt = 0;
    this.asleep = false;
    this.resetDue = false;
    this.timerOf = new Map();
    this.ports = job.ports.map((port) => new AVRIOPort(cpu, port));
    this.timers = job.timers.map((config) => this.addTimer(config));
    this.usart = new AVRUSART(cpu, job.usart, job.f_cpu_hz);
    this.usart.onByteTransmit = (byte) => this.record(KIND.UART, this.writeEdge(), job.usart.UDR, byte);
    if (job.usb && this.correct) plugIn(cpu, job.usb, job.f_cpu_hz, this.hookWrite.bind(this));
    this.usart.onRxComplete = () => this.feedSerial();
    const dog = { interrupt: job.watchdog, fCpuHz: job.f_cpu_hz };
    if (this.correct) addWatchdog(cpu, dog, causes, () => { this.resetDue = true; });
    else addRawWatchdog(cpu, dog);
    job.ports.forEach((port, index) => this.recordPort(port, this.ports[index]));
    this.hookWrite(EEDR, (value) => this.mark(value));
    for (const address of job.watch) this.watch(address);
    const setFlag = cpu.setInterruptFlag.bind(cpu);
    cpu.setInterruptFlag = (interrupt) => { this.noteRaise(interrupt); setFlag(interrupt); };
  }

  // The watchdog's reset: RAM is as it was, and no pin is driven.
  reset() {
    const before = this.cpu, causes = before.data[MCUSR] | WDRF;
    for (const { DDR, PORT } of this.job.ports) {
      for (const address of [DDR, PORT]) {
        if (before.data[address]) this.record(KIND.PORT, before.cycles, address, 0);
      }
    }
    this.record(KIND.RESET, before.cycles, MCUSR, causes);
    const after = new CPU(this.flash, before.sramBytes);
    const { ram_start: ram } = this.job;
    after.data.set(before.data.subarray(ram), ram);
    after.cycles = before.cycles;
    this.start(after, causes);
    if (this.serial.length) this.feedSerial();
  }

  record(kind, cycle, source, value, since = 0, maskedUntil = 0) {
    this.rows.push(cycle, since, maskedUntil, value, source, kind);
  }

  writeEdge() {
    return this.cpu.cycles + accessCycles(this.cpu);
  }

  // Calls *after* when the register has been written; avr8js's own hook goes first.
  hookWrite(address, after) {
    const own = this.cpu.writeHooks[address];
    this.cpu.writeHooks[address] = (value, old, at, mask) => {
      if (!(own && own(value, old, at, mask))) this.cpu.data[at] = value;
      after(value, old, mask);
      return true;
    };
  }

  watch(address) {
    this.hookWrite(address, (value) => this.record(KIND.REGISTER, this.writeEdge(), address, value));
  }

  // A port shows PORTx, but for the pins that compare units drive in its place.
  recordPort({ PIN, DDR, PORT }, port) {
    const { cpu } = this;
    const shown = {
      [DDR]: () => cpu.data[DDR],
      [PORT]: () => (cpu.data[PORT] & port.overrideMask) | port.overrideValue,
    };
    const noting = (changed, edge, act) => {
      const before = shown[changed]();
      act();
      const now = shown[changed]();
      if (now !== before) this.record(KIND.PORT, edge, changed, now);
    };
    for (const [written, changed] of [[PIN, PORT], [DDR, DDR], [PORT, PORT]]) {
      const own = cpu.writeHooks[written];
      cpu.writeHooks[written] = (value, old, at, mask) => {
        noting(changed, this.writeEdge(), () => own(value, old, at, mask));
        return true;
      };
    }
    const drive = port.timerOverridePin.bind(port);
    port.timerOverridePin = (pin, mode) => {
      noting(PORT, this.matchEdge ?? this.writeEdge(), () => drive(pin, mode));
    };
  }

  // A match changes its pin at the edge of its flag.
  noteMatches(timer) {
    const update = timer.timerUpdated.bind(timer);
    timer.timerUpdated = (now, before) => {
      update(now, before);
      this.matchEdge = undefined;
    };
  }

  mark(value) {
    this.record(KIND.MARK, this.writeEdge(), EEDR, value);
    if (value === this.wantedMark) this.marked = true;
  }

  addTimer(config) {
    const timer = new AVRTimer(this.cpu, config);
    for (const interrupt of [timer.OVF, timer.OCFA, timer.OCFB, timer.OCFC]) {
      this.timerOf.set(interrupt, timer);
    }
    this.noteEnables(config);
    if (this.correct) {
      letPrescalerRun(this.cpu, timer);
      accessInTime(this.cpu, timer);
      clearOnlyWrittenFlags(this.cpu, timer);
      clearChannelC(this.cpu, timer);
      countOnToMax(timer);
      compareWhenLeft(this.cpu, timer);
    }
    this.noteMatches(timer);
    return timer;
  }

  noteEnables({ TIMSK, enables }) {
    this.hookWrite(TIMSK, (value, old) => {
      for (const [mask, vector] of enables) {
        if (value & ~old & mask) this.enabledAt[vector] = this.writeEdge();
      }
    });
  }

  noteRaise(interrupt) {
    const { cpu } = this;
    const timer = this.timerOf.get(interrupt);
    const vector = interrupt.address / WORDS_PER_VECTOR;
    const edge = timer ? raiseEdge(interrupt, timer, this.correct) : cpu.cycles;
    const already = cpu.data[interrupt.flagRegister] & interrupt.flagMask ? 1 : 0;
    if (timer) this.matchEdge = edge;
    if (!already) this.raisedAt[vector] = edge;
    if (timer && timer.config.recorded && cpu.data[interrupt.enableRegister] & interrupt.enableMask) {
      this.record(KIND.RAISE, edge, vector, already);
    }
  }

  // Everything that is due; avr8js's own tick() does one thing for each instruction.
  settle() {
    const { cpu } = this;
    let event;
    while ((event = cpu.nextClockEvent) && event.cycles <= cpu.cycles) {
      cpu.nextClockEvent = event.next;
      event.callback();
      if (!this.correct) break;
    }
  }

  interrupt() {
    const { cpu } = this;
    const address = cpu.nextInterrupt;
    if (this.resetDue || !(cpu.data[SREG] & I_FLAG) || address < 0) return;
    const vector = address / WORDS_PER_VECTOR;
    const since = this.raisedAt[vector] ?? cpu.cycles;
    const open = Math.max(since, this.unmaskedAt, this.enabledAt[vector] ?? 0);
    const entered = cpu.cycles;
    this.record(KIND.ISR_ENTER, entered, vector, cpu.pc * 2, since, open);
    this.frames.push([vector, entered]);
    const pending = cpu.pendingInterrupts[address];
    const dispatch = cpu.tick;  // its clock events are settled, so it only takes the interrupt
    const event = cpu.nextClockEvent;
    cpu.nextClockEvent = null;
    dispatch.call(cpu);
    cpu.nextClockEvent = event;
    if (pending.constant) this.raisedAt[vector] = undefined;
    if (this.correct) {
      cpu.cycles += this.job.response_cycles - LIBRARY_RESPONSE + (this.asleep ? WAKE_CYCLES : 0);
    }
    this.asleep = false;
    this.settle();
  }

  // One instruction and what is due after it. The instruction after one that sets the I flag,
  // and after RETI, comes before any interrupt.
  step() {
    const { cpu } = this;
    const opcode = cpu.progMem[cpu.pc];
    const before = cpu.data[SREG] & I_FLAG;
    avrInstruction(cpu);
    if (this.correct && (opcode & CBI_MASK) === CBI) cpu.cycles++;  // avr8js: 1 cycle
    const now = cpu.data[SREG] & I_FLAG;
    this.settle();
    if (opcode === RETI) this.leave();
    if (now !== before && this.fine && !this.frames.length && opcode !== RETI) {
      this.record(now ? KIND.UNMASKED : KIND.MASKED, cpu.cycles, 0, 0);
    }
    if (now && !before) this.unmaskedAt = cpu.cycles;
    if (opcode === SLEEP && this.correct) this.sleep();
    if (this.correct && now && (!before || opcode === RETI)) return;
    this.interrupt();
  }

  leave() {
    const frame = this.frames.pop();
    if (frame) this.record(KIND.ISR_EXIT, this.cpu.cycles, frame[0], 0, frame[1]);
  }

  sleep() {
    const control = this.cpu.data[SMCR];
    if (!(control & SLEEP_ENABLE)) return;
    if (control & SLEEP_MODE) this.error = "a sleep mode other than idle is not simulated";
    else if (!(this.cpu.data[SREG] & I_FLAG)) this.error = "asleep with interrupts off, for ever";
    else this.asleep = true;
  }

  doze(until) {
    const { cpu } = this;
    const event = cpu.nextClockEvent;
    cpu.cycles = Math.max(cpu.cycles + 1, event ? Math.min(event.cycles, until) : until);
    this.settle();
    this.interrupt();
  }

  run({ until, mark }) {
    this.wantedMark = mark;
    this.marked = false;
    const end = this.job.image_bytes / 2;
    while (this.cpu.cycles < until && !this.marked && !this.error) {
      if (this.asleep) this.doze(until);
      else this.step();
      if (this.resetDue) this.reset();
      const { pc } = this.cpu;
      if (pc >= end) this.error = `left the program, at ${(pc * 2).toString(16)}`;
    }
    const { cycles, pc } = this.cpu;
    return { cycle: cycles, marked: this.marked, error: this.error, pc: pc * 2 };
  }

  setFine({ on }) {
    this.fine = on;
    return {};
  }

  read({ address, size }) {
    return { bytes: Array.from(this.cpu.data.subarray(address, address + size)) };
  }

  write({ address, bytes }) {
    this.cpu.data.set(bytes, address);
    return {};
  }

  register({ address }) {
    const timer = this.timers.find(({ config }) => address === config.TCNT || address === config.TCNT + 1);
    if (!timer) return { value: this.cpu.data[address] };
    timer.count(false);
    return { value: address === timer.config.TCNT ? timer.tcnt & 0xff : timer.tcnt >> 8 };
  }

  drive({ port, bit, high }) {
    this.cpu.gpioByPort[port].setPin(bit, high);
    return {};
  }

  send({ bytes }) {
    this.serial.push(...bytes);
    this.feedSerial();
    return {};
  }

  // The next byte of the line, once the receiver is on and the byte before is complete.
  feedSerial() {
    if (!this.serial.length) return;
    const taken = this.usart.rxEnable && this.usart.writeByte(this.serial[0]);
    if (taken) this.serial.shift();
    else this.cpu.addClockEvent(() => this.feedSerial(), SERIAL_RETRY_CYCLES);
  }

  events() {
    const rows = new Float64Array(this.rows);
    return { fields: FIELDS, rows: Buffer.from(rows.buffer).toString("base64") };
  }
}

module.exports = { Machine };
