// two lines
// for people
// bit 0: light
// bit 1: tap_1
// bit 2: tap_2
// bit 3: trigger
// word of point j of exposure e (both from 0): e * 3 + j
package pattern_pkg;
  localparam int WORD_BITS = 4;
  localparam int WORDS = 6;
  localparam int POINTS_PER_EXPOSURE = 3;
  localparam int LIGHT_FIRST_BIT = 0;
  localparam int LIGHT_BITS = 1;
  localparam int TAP_1_FIRST_BIT = 1;
  localparam int TAP_1_BITS = 1;
  localparam int TAP_2_FIRST_BIT = 2;
  localparam int TAP_2_BITS = 1;
  localparam int TRIGGER_FIRST_BIT = 3;
  localparam int TRIGGER_BITS = 1;
  localparam logic [3:0] PATTERN [0:5] = '{
    4'hb,
    4'h9,
    4'h4,
    4'hd,
    4'ha,
    4'h1
  };
endpackage
