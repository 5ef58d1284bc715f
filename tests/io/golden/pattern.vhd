-- two lines
-- for people
-- bit 0: light
-- bit 1: tap_1
-- bit 2: tap_2
-- bit 3: trigger
-- word of point j of exposure e (both from 0): e * 3 + j
library ieee;
use ieee.std_logic_1164.all;

package pattern_pkg is
  constant WORD_BITS : natural := 4;
  constant WORDS : natural := 6;
  constant POINTS_PER_EXPOSURE : natural := 3;
  constant LIGHT_FIRST_BIT : natural := 0;
  constant LIGHT_BITS : natural := 1;
  constant TAP_1_FIRST_BIT : natural := 1;
  constant TAP_1_BITS : natural := 1;
  constant TAP_2_FIRST_BIT : natural := 2;
  constant TAP_2_BITS : natural := 1;
  constant TRIGGER_FIRST_BIT : natural := 3;
  constant TRIGGER_BITS : natural := 1;
  type pattern_t is array (0 to 5) of std_logic_vector(3 downto 0);
  constant PATTERN : pattern_t := (
    0 => "1011",
    1 => "1001",
    2 => "0100",
    3 => "1101",
    4 => "1010",
    5 => "0001"
  );
end package pattern_pkg;
