"""
One spec of each kind: board, drive, timing, motion and way to change the ports.
"""

KINDS = (
    "uno_motor_shield",
    "uno_uln2003_28byj48",
    "uno_mixed_ports",
    "mega_pan_tilt",
    "mega_uln2003_port_g",
    "mega_stacked_shields",
    "mega_stacked_shields_variable",
    "uno_variable_speed",
    "uno_three_ports_variable",
    "pro-mini-8mhz_28byj48",
    "uno_servo_beside",
    "uno_servo_beside_variable",
    "uno_two_motors",
    "mega_ramps_z",
    "uno_cnc_shield",
    "uno_drv8825",
    "leonardo_motor_shield",
    "micro_slider",
    "uno_command_timeout",
    "mega_command_timeouts",
    "uno_compare_two",
    "uno_compare_28byj48",
    "mega_compare_three",
    "uno_slow",
    "uno_trapezoid",
    "uno_homing",
    "mega_ramps_limits",
)
