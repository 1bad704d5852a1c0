/* simavr with the chip's own interrupts, timers 1 to 5 and port writes, and a record of
 * what happened.
 *
 * Cycles. An instruction that starts at c and takes n cycles ends at c + n; PORT, REGISTER,
 * MARK and UART events carry c + n (out takes 1, sts, st, sbi and cbi 2). ISR_ENTER is
 * the instruction boundary at which the interrupt is taken, before the response of 4
 * cycles (5 with a 3-byte PC; 4 more from sleep); ISR_EXIT is the end of RETI. MASKED and
 * UNMASKED are the end of the instruction that changed the I flag. RAISE is the edge at
 * which the flag is set. Records are in the order of these cycles but for one instruction:
 * a RAISE inside an instruction may follow that instruction's write. */

#ifndef STEPGEN_HARNESS_H
#define STEPGEN_HARNESS_H

#include <stdint.h>

#include "api.h"

#endif
