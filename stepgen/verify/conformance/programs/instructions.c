/* One instruction after another between marks 1 and 2, in the order of the test's table;
 * mark 3 ends it. */
#include <avr/io.h>

#define TIMED(code) "out %0, r17\n\t" code "\n\tout %0, r16\n\t"
#define TARGET(label) "ldi r30, lo8(gs(" label "))\n\tldi r31, hi8(gs(" label "))\n\t"
#define POINTERS                                                                       \
  "ldi r26, 0x20\n\tldi r27, 1\n\tldi r28, 0x40\n\tldi r29, 1\n\tclr r30\n\tclr r31\n\t"

int main(void)
{
  asm volatile(
      "ldi r17, 1\n\tldi r16, 2\n\tldi r18, 0xFF\n\tldi r20, 5\n\t"
      TIMED("nop") TIMED("add r20, r18") TIMED("movw r24, r20") TIMED("ldi r24, 7")
      TIMED("adiw r24, 1") TIMED("mul r20, r18") TIMED("sbiw r24, 1")
      POINTERS
      TIMED("lds r20, 0x200") TIMED("sts 0x200, r20") TIMED("ld r20, X")
      TIMED("ld r20, -X") TIMED("std Y+1, r20") TIMED("ldd r20, Y+1")
      TIMED("lpm r20, Z") TIMED("lpm r20, Z+")
      TIMED("push r20") TIMED("pop r20") TIMED("in r20, 0x3D") TIMED("out 0x1E, r17")
      TIMED("sbi 0x1E, 0") TIMED("cbi 0x1E, 1")
      TIMED("rjmp 1f\n1:") TIMED("jmp 1f\n1:") TARGET("1f") TIMED("ijmp\n1:")
      "sez\n\t" TIMED("brne 1f\n1:") TIMED("breq 1f\n1:")
      TIMED("sbrs r16, 0")
      TIMED("sbrs r17, 0\n\tnop") TIMED("sbrs r17, 0\n\tjmp 0")
      TIMED("cpse r16, r17") TIMED("cpse r16, r16\n\tnop") TIMED("cpse r16, r16\n\tjmp 0")
      TIMED("sbis 0x1E, 1") TIMED("sbis 0x1E, 0\n\tnop") TIMED("sbis 0x1E, 0\n\tjmp 0")
      TIMED("rcall 9f") TIMED("call 9f") TARGET("9f") TIMED("icall")
      "ldi r16, 3\n\tout %0, r16\n"
      "8:\trjmp 8b\n"
      "9:\tret" ::"I"(_SFR_IO_ADDR(EEDR)));
}
