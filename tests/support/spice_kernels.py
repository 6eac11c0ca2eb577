"""A leapseconds kernel and an epoch for tests with SPICE."""

LEAPSECONDS = r"""KPL/LSK
\begindata
DELTET/DELTA_T_A = 32.184
DELTET/K         = 1.657D-3
DELTET/EB        = 1.671D-2
DELTET/M         = ( 6.239996D0  1.99096871D-7 )
DELTET/DELTA_AT  = ( 36, @2015-JUL-1, 37, @2017-JAN-1 )
\begintext
"""
EPOCH = "2026-01-01T00:00:00"
# Seconds since J2000 are 8.2e8; their rounding, and that of ticks, is 1.2e-7 s.
CLOCK_ERROR = 2.5e-7
