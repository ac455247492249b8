//! Philox4x32-10 of Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011: random words as a
//! function of a counter, the same in any order.

/// Multipliers of the rounds.
const FACTORS: [u32; 2] = [0xD251_1F53, 0xCD9E_8D57];
/// Addition to the key between the rounds.
const WEYL: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];
/// Rounds.
const ROUNDS: usize = 10;

/// High and low half of a product.
#[inline(always)]
#[allow(clippy::cast_possible_truncation)] // the halves are what is asked for
fn product(one: u32, two: u32) -> (u32, u32) {
    let whole = u64::from(one) * u64::from(two);
    ((whole >> 32) as u32, whole as u32)
}

/// Four random words of a counter and a key.
#[must_use]
pub fn philox(counter: [u32; 4], key: [u32; 2]) -> [u32; 4] {
    side_by_side(counter.map(|word| [word]), key).map(|[word]| word)
}

/// Words of counters side by side, one a lane.
#[inline(always)]
#[must_use]
pub fn side_by_side<const N: usize>(counter: [[u32; N]; 4], mut key: [u32; 2]) -> [[u32; N]; 4] {
    let mut words = counter;
    for round in 0..ROUNDS {
        if round > 0 {
            key = [key[0].wrapping_add(WEYL[0]), key[1].wrapping_add(WEYL[1])];
        }
        let [first, second, third, fourth] = &mut words;
        for lane in 0..N {
            let (high, low) = product(FACTORS[0], first[lane]);
            let (other_high, other_low) = product(FACTORS[1], third[lane]);
            first[lane] = other_high ^ second[lane] ^ key[0];
            second[lane] = other_low;
            third[lane] = high ^ fourth[lane] ^ key[1];
            fourth[lane] = low;
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_the_published_words() {
        // Known-answer vectors of Random123.
        let ones = u32::MAX;
        let zeros = [0x6627_E8D5, 0xE169_C58D, 0xBC57_AC4C, 0x9B00_DBD8];
        assert_eq!(philox([0; 4], [0; 2]), zeros);
        let full = [0x408F_276D, 0x41C8_3B0E, 0xA20B_C7C6, 0x6D54_51FD];
        assert_eq!(philox([ones; 4], [ones; 2]), full);
        let words = [0xD16C_FE09, 0x94FD_CCEB, 0x5001_E420, 0x2412_6EA1];
        let counter = [0x243F_6A88, 0x85A3_08D3, 0x1319_8A2E, 0x0370_7344];
        assert_eq!(philox(counter, [0xA409_3822, 0x299F_31D0]), words);
        let call = philox([1, 2, 3, 0], [7, 1_297_109_065]);
        assert_eq!(
            call,
            [2_367_977_653, 2_375_997_532, 4_118_583_391, 187_370_960]
        );
    }
}
