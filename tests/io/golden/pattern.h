// two lines
// for people
// bit 0: light
// bit 1: tap_1
// bit 2: tap_2
// bit 3: trigger
// word of point j of exposure e (both from 0): e * 3 + j
#ifndef PATTERN_H
#define PATTERN_H

#include <stdint.h>

#define PATTERN_WORD_BITS 4
#define PATTERN_WORDS 6
#define PATTERN_POINTS_PER_EXPOSURE 3
#define PATTERN_LIGHT_FIRST_BIT 0
#define PATTERN_LIGHT_BITS 1
#define PATTERN_TAP_1_FIRST_BIT 1
#define PATTERN_TAP_1_BITS 1
#define PATTERN_TAP_2_FIRST_BIT 2
#define PATTERN_TAP_2_BITS 1
#define PATTERN_TRIGGER_FIRST_BIT 3
#define PATTERN_TRIGGER_BITS 1

static const uint8_t pattern[6] = {
    0xbu,
    0x9u,
    0x4u,
    0xdu,
    0xau,
    0x1u
};

#endif
