//! Numbers that look random and follow from a seed, a key and a row alone, so that any row can be drawn by itself.

/// Mixes all bits (the finalizer of SplitMix64).
fn mixed(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A number that follows from three others.
pub(crate) fn hash(seed: u64, stream: u64, index: u64) -> u64 {
    let golden = 0x9e37_79b9_7f4a_7c15_u64;
    let keyed = mixed(seed.wrapping_add(golden.wrapping_mul(stream.wrapping_add(1))));
    mixed(keyed.wrapping_add(golden.wrapping_mul(index.wrapping_add(1))))
}

/// The leading bits as a number in [0, 1).
pub(crate) fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

/// Where `index` goes in a permutation of 0..`count`, without a table: a Feistel network on the next even power of two,
/// walked until it is back inside.
pub(crate) fn permuted(seed: u64, stream: u64, count: u64, index: u64) -> u64 {
    const ROUNDS: u64 = 6;
    let bits = u64::from(u64::BITS - count.saturating_sub(1).leading_zeros());
    let half = bits.div_ceil(2).max(1);
    let mask = (1_u64 << half) - 1;
    let mut at = index;
    loop {
        let (mut left, mut right) = (at >> half, at & mask);
        for round in 0..ROUNDS {
            let scrambled = hash(seed, stream.wrapping_mul(ROUNDS).wrapping_add(round), right) & mask;
            (left, right) = (right, left ^ scrambled);
        }
        at = (left << half) | right;
        if at < count {
            return at;
        }
    }
}
