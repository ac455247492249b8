//! Numbers as bits.

/// Bits of a computed number; Rust leaves the sign and the payload of a computed NaN open.
pub fn computed(value: f64) -> u64 {
    if value.is_nan() {
        f64::NAN.to_bits()
    } else {
        value.to_bits()
    }
}
