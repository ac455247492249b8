//! The generator of numpy, PCG64 from a seed, with the same numbers: scenes that are drawn here are
//! those that `numpy.random.Generator(PCG64(seed))` draws.

/// Multiplier of the state, O'Neill (2014).
const MULTIPLIER: u128 = 0x2360_ed05_1fc6_5da4_4385_df64_9fcc_f645;

/// Words that a seed is spread over.
const POOL: usize = 4;

/// Uniform numbers.
#[derive(Clone, Debug)]
pub struct Pcg64 {
    state: u128,
    increment: u128,
}

impl Pcg64 {
    /// From a seed, as numpy's `SeedSequence` spreads it.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let [state, stream] = spread(seed);
        let increment = (stream << 1) | 1;
        let mut made = Self {
            state: 0,
            increment,
        };
        made.step();
        made.state = made.state.wrapping_add(state);
        made.step();
        made
    }

    fn step(&mut self) {
        let state = self.state.wrapping_mul(MULTIPLIER);
        self.state = state.wrapping_add(self.increment);
    }

    /// The next 64 bits: both halves folded and turned by the topmost bits.
    #[allow(clippy::cast_possible_truncation)] // halves and six bits
    fn bits(&mut self) -> u64 {
        self.step();
        let folded = (self.state >> 64) as u64 ^ self.state as u64;
        folded.rotate_right((self.state >> 122) as u32)
    }

    /// The next number, uniform in `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }
}

/// One step of the hash of a seed; the constant changes with every use.
fn hashed(mut value: u32, constant: &mut u32, multiplier: u32) -> u32 {
    value ^= *constant;
    *constant = constant.wrapping_mul(multiplier);
    value = value.wrapping_mul(*constant);
    value ^ (value >> 16)
}

fn mixed(one: u32, other: u32) -> u32 {
    let left = one.wrapping_mul(0xca01_f9dd);
    let both = left.wrapping_sub(other.wrapping_mul(0x4973_f715));
    both ^ (both >> 16)
}

/// State and stream from a seed.
#[allow(clippy::cast_possible_truncation)] // words of the seed
fn spread(seed: u64) -> [u128; 2] {
    let mut constant = 0x43b0_d7e5;
    let mut entropy = |word: u32| hashed(word, &mut constant, 0x931e_8875);
    let mut pool = [seed as u32, (seed >> 32) as u32, 0, 0].map(&mut entropy);
    for from in 0..POOL {
        for to in (0..POOL).filter(|to| *to != from) {
            pool[to] = mixed(pool[to], entropy(pool[from]));
        }
    }
    let mut constant = 0x8b51_f9dd;
    let mut words = [0_u128; 2 * POOL];
    for (index, word) in words.iter_mut().enumerate() {
        *word = hashed(pool[index % POOL], &mut constant, 0x58f3_8ded).into();
    }
    // Two words make 64 bits, the lower one first; two of those make 128, the higher one first.
    let wide = |at: usize| words[at] | (words[at + 1] << 32);
    [0, 4].map(|at| (wide(at) << 64) | wide(at + 2))
}

#[cfg(test)]
mod tests {
    use super::Pcg64;

    #[test]
    fn numbers_are_those_of_numpy() {
        // numpy.random.Generator(numpy.random.PCG64(seed)).random(3)
        for (seed, expected) in [
            (
                0,
                [
                    0.636_961_687_321_454_3,
                    0.269_786_713_763_870_3,
                    0.040_973_523_936_194_69,
                ],
            ),
            (
                1 << 40 | 7,
                [
                    0.829_812_891_829_413,
                    0.255_305_158_349_104_17,
                    0.153_790_715_852_987_54,
                ],
            ),
        ] {
            let mut draws = Pcg64::new(seed);
            assert_eq!([0; 3].map(|_| draws.unit()), expected);
        }
    }
}
