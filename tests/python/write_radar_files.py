"""Writes small files of radar instruments, made from the descriptions of the formats alone; needs nothing but Python.

Usage: write_radar_files.py FOLDER

Every file holds traces of the amplitudes `amplitude(channel, trace, sample)` times a factor of its own.
"""

import math
import struct
import sys
from pathlib import Path

ROOT = Path(sys.argv[1])
TRACES, SAMPLES = 5, 12


def amplitude(channel, trace, sample):
    return (29 * channel + 7 * trace + 13 * sample) % 101 - 50


def save(name, content):
    path = ROOT / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)


def rows(factor=1):
    return [[factor * amplitude(0, trace, sample) for sample in range(SAMPLES)] for trace in range(TRACES)]


def dzt(name, bits, channels, factor, headers=1, scans_per_metre=20.0, antenna=b"41000SA"):
    """`headers` blocks of 1024 bytes; the first two samples of a scan are the scan counter and a marker."""
    code, zero = {8: ("B", 128), 16: ("H", 32768), 32: ("i", 0)}[bits]
    head = bytearray(1024 * headers)
    for channel in range(channels):
        at = 1024 * channel
        struct.pack_into("<HHHHhfffff", head, at, 0x7FF, headers if headers > 1 else 1024, SAMPLES + 2, bits, 0, 100.0,
                         scans_per_metre, 0.0, -3.0, 28.0)
        struct.pack_into("<H", head, at + 52, channels)
        struct.pack_into("<f", head, at + 54, 6.0)
        struct.pack_into("14s", head, at + 98, antenna)
    body = b""
    for trace in range(TRACES):
        for channel in range(channels):
            signal = [zero + factor * amplitude(channel, trace, sample) for sample in range(SAMPLES)]
            body += struct.pack(f"<{SAMPLES + 2}{code}", trace, 0, *signal)
    save(name, bytes(head) + body)


def dt1(name, factor, unit, position_of):
    lines = ["1234", "Data Collected with pE PRO ", "2017-04-11 "]
    fields = {
        "NUMBER OF TRACES": TRACES, "NUMBER OF PTS/TRC": SAMPLES, "TIMEZERO AT POINT": 3.25,
        "TOTAL TIME WINDOW": f"{SAMPLES * 0.4:.3f}", "STARTING POSITION": position_of(0),
        "FINAL POSITION": position_of(TRACES - 1), "STEP SIZE USED": 0.5, "POSITION UNITS": unit,
        "NOMINAL FREQUENCY": "250.00", "ANTENNA SEPARATION": 1.0, "NUMBER OF STACKS": 8, "SURVEY MODE": "Reflection",
    }
    lines += [f"{key:<18} = {value} " for key, value in fields.items()]
    save(name + ".hd", "".join(line + "\r\r\n" for line in lines).encode())
    body = b""
    for trace, row in enumerate(rows(factor)):
        words = [trace + 1, position_of(trace), SAMPLES, 0, 0, 2, 400, 8]
        body += struct.pack("<8f3d11f28s", *words, *[0.0] * 3, *[0.0] * 11, b"comment")
        body += struct.pack(f"<{SAMPLES}h", *row)
    save(name + ".dt1", body)


def mala(name, ending, code, factor):
    fields = [("SAMPLES", SAMPLES), ("FREQUENCY", "2500.000000"), ("FREQUENCY STEPS", 17), ("DISTANCE FLAG", 1),
              ("DISTANCE INTERVAL", " 0.250000"), ("ANTENNAS", "500 MHz shielded"), ("ANTENNA SEPARATION", " 0.180000"),
              ("COMMENT", ""), ("TIMEWINDOW", f"{SAMPLES * 0.4:.6f}"), ("STACKS", 4), ("LAST TRACE", TRACES)]
    save(f"{name}.rad", "".join(f"{key}:{value}\r\n" for key, value in fields).encode())
    save(f"{name}.{ending}", b"".join(struct.pack(f"<{SAMPLES}{code}", *row) for row in rows(factor)))


def ibm(value):
    """Base 16, a fraction of 24 bits below 1, an exponent above 64."""
    if value == 0:
        return 0
    exponent = math.floor(math.log(abs(value), 16)) + 1
    fraction = round(abs(value) / 16.0**exponent * 2**24)
    return (0x80000000 if value < 0 else 0) | (exponent + 64) << 24 | fraction


def segy(name, order, code, factor):
    kind = {1: "I", 2: "i", 3: "h", 5: "f"}[code]
    head = bytearray(3600)
    text = "".join(f"C{line:>2} {'A LINE OF TEXT' if line == 1 else '':<76}" for line in range(1, 41))
    head[:3200] = text.encode("cp037" if order == ">" else "ascii")
    for at, value in [(3216, 400), (3220, SAMPLES), (3224, code)]:
        struct.pack_into(order + "h", head, at, value)
    body = b""
    for trace, row in enumerate(rows(factor)):
        one = bytearray(240)
        struct.pack_into(order + "i", one, 0, trace + 1)
        struct.pack_into(order + "h", one, 70, -100)
        struct.pack_into(order + "ii", one, 80, 25 * trace, 700)
        struct.pack_into(order + "hh", one, 114, SAMPLES, 400)
        struct.pack_into(order + "h", one, 88, 1)
        body += bytes(one) + struct.pack(f"{order}{SAMPLES}{kind}", *[ibm(v) if code == 1 else v for v in row])
    save(name, bytes(head) + body)


def iprb(name, bits, code, factor):
    fields = [("HEADER VERSION", 20), ("DATA VERSION", bits), ("DATE", "2022-12-08"), ("SAMPLES", SAMPLES),
              ("LAST TRACE", TRACES), ("TIMEWINDOW", SAMPLES * 0.4), ("ZERO LEVEL", 3), ("ANTENNA", "600 MHz"),
              ("USER DISTANCE INTERVAL", "0.05")]
    save(f"{name}.iprh", "".join(f"{key}: {value}\r\n" for key, value in fields).encode())
    save(f"{name}.iprb", b"".join(struct.pack(f"<{SAMPLES}{code}", *row) for row in rows(factor)))


def ids(name, factor):
    record = 1024
    head = bytearray(3 * record)
    struct.pack_into("<4sh", head, 0, b"V100", record)
    struct.pack_into("4s", head, record, b"FC  ")
    struct.pack_into("<4s11i", head, 2 * record, b"H   ", 0, 0, 0, TRACES, SAMPLES, 0, 0, 0, 0, 0, 0)
    numbers = ["600", "1e8", "0", f"{0.4e-9 * (SAMPLES - 1):.6e}", "0", "0", "0.05", "0", "0.05", "0.01"]
    for index, number in enumerate(numbers):
        struct.pack_into("16s", head, 2 * record + 48 + 16 * index, number.encode())
    body = b""
    for trace, row in enumerate(rows(factor)):
        body += struct.pack(f"<2sh{SAMPLES}h", b"R0", 0, *row)
    save(name, bytes(head) + body)


dzt("dzt/eight-bits.dzt", 8, 1, 1)
dzt("dzt/sixteen-bits.dzt", 16, 1, 300, antenna=b"400MHz")
dzt("dzt/two-channels.dzt", 16, 2, 300, headers=2, scans_per_metre=0.0)
dzt("dzt/thirty-two-bits.dzt", 32, 1, 100003)
dt1("dt1/feet", 300, "ft", lambda trace: 0.5 * trace)
dt1("dt1/metres", 300, "m", lambda trace: 10 + 0.25 * trace)
mala("mala/short", "rd3", "h", 300)
mala("mala/long", "rd7", "i", 100003)
for order, word in [(">", "big"), ("<", "little")]:
    for code, kind, factor in [(1, "ibm", 0.375), (2, "thirty-two-bits", 100003), (3, "sixteen-bits", 300), (5, "ieee", 0.375)]:
        segy(f"segy/{word}-{kind}.sgy", order, code, factor)
iprb("iprb/short", 16, "h", 300)
iprb("iprb/long", 32, "i", 100003)
ids("ids/line.dt", 300)
