/* What Python sees of the harness. cffi reads this file as its cdef, so it holds
 * declarations only: no #include, no #if; harness.h wraps it for the compiler. */

enum event_kind {
    EVENT_PORT = 1,      /* source: address of PORTx or DDRx; value: what it now holds */
    EVENT_REGISTER = 2,  /* source: a watched address; value: the byte written */
    EVENT_MARK = 3,      /* source: EEDR; value: the byte written */
    EVENT_ISR_ENTER = 4, /* source: vector; value: interrupted byte address in flash */
    EVENT_ISR_EXIT = 5,  /* source: vector; value: stack bytes this run of it took */
    EVENT_UART = 6,      /* source: UDRn, or UEDATX for USB; value: the byte sent */
    EVENT_MASKED = 7,    /* the main program cleared the I flag (fine recording only) */
    EVENT_UNMASKED = 8,  /* the main program set the I flag (fine recording only) */
    EVENT_RAISE = 9,     /* source: vector of a timer but 0; value: 1 if already raised */
    EVENT_RESET = 10     /* source: MCUSR; value: what it holds from then on */
};

typedef struct {
    uint64_t cycle;        /* CPU cycles since reset; see harness.h for each kind */
    uint64_t since;        /* ISR_ENTER: the flag was set; ISR_EXIT: the ISR was entered */
    uint64_t masked_until; /* ISR_ENTER: the last masking between since and cycle ended */
    uint32_t value;
    uint16_t source;
    uint16_t kind;
} event;

enum run_result { RUN_REACHED = 0, RUN_MARKED = 1, RUN_FAILED = 2 };

typedef struct machine machine;
struct avr_t; /* simavr's own */

machine *machine_new(const char *mcu, uint32_t f_cpu_hz, const uint8_t *code, uint32_t size);
void machine_free(machine *m);
const char *machine_error(const machine *m);

int machine_watch(machine *m, uint16_t address);
int machine_run(machine *m, uint64_t until, int wanted_mark);
int machine_run_to_zero(machine *m, uint16_t address, uint64_t step, uint64_t until);
void machine_reset(machine *m, int cause);
uint64_t machine_cycle(const machine *m);
uint32_t machine_pc(const machine *m);
void machine_set_fine(machine *m, int on);
void machine_set_recording(machine *m, int on);

uint32_t machine_ram_end(const machine *m);
uint8_t *machine_data(machine *m);
uint8_t machine_register(machine *m, uint16_t address);
int machine_drive_pin(machine *m, uint16_t pin_address, int bit, int level);
void machine_send_serial(machine *m, const uint8_t *bytes, uint32_t size);
uint32_t machine_serial_waiting(const machine *m);
uint32_t machine_serial_lost(const machine *m);
void machine_send_usb(machine *m, const uint8_t *bytes, uint32_t size);
uint32_t machine_usb_waiting(const machine *m);

uint32_t machine_isr_stack(const machine *m, int vector);
uint32_t machine_stack_deepest(const machine *m);

event *events_map(machine *m);
void events_unmap(event *region);
uint64_t events_count(const machine *m);
void events_clear(machine *m);

struct avr_t *plain_new(const char *mcu, uint32_t f_cpu_hz, const uint8_t *code, uint32_t size);
void plain_free(struct avr_t *avr);
void plain_run(struct avr_t *avr, uint64_t until);
uint8_t *plain_data(struct avr_t *avr);
