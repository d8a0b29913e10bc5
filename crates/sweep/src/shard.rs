//! Shares of a sweep: whole tiles where there are as many, else parts of tiles.

use std::ops::Range;

use crate::error::SweepError;
use crate::plan::Plan;

/// One of several equal fractions of a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Which, from 1.
    pub index: u64,
    /// Of how many.
    pub of: u64,
}

/// The rows of consecutive tiles.
pub(crate) fn rows_of(plan: &Plan, tiles: &Range<u64>) -> Range<u64> {
    plan.tile(tiles.start).start..plan.tile(tiles.end.saturating_sub(1)).end
}

/// What two ranges have in common, empty where that is nothing.
pub(crate) fn common(a: &Range<u64>, b: &Range<u64>) -> Range<u64> {
    let start = a.start.max(b.start);
    start..a.end.min(b.end).max(start)
}

/// The tiles of a shard, and its rows. Rows of a tile are solved one after the other, each from the last: where there are more shards than
/// tiles, a shard solves the tiles that its rows are in and writes its own, so that they are those of the whole sweep to the last bit.
///
/// # Errors
/// [`SweepError::Shard`] for a shard that does not exist, or more shards than rows.
pub(crate) fn tiles_and_rows(plan: &Plan, Shard { index, of }: Shard) -> Result<(Range<u64>, Range<u64>), SweepError> {
    let (rows, tiles) = (plan.rows(), plan.tiles());
    if index == 0 || index > of || of > rows {
        return Err(SweepError::Shard { index, of, rows });
    }
    let part = |whole: u64| {
        let at = |shard: u64| u64::try_from(u128::from(whole) * u128::from(shard) / u128::from(of)).unwrap_or(whole);
        at(index - 1)..at(index)
    };
    if of <= tiles {
        let tiles = part(tiles);
        let rows = rows_of(plan, &tiles);
        return Ok((tiles, rows));
    }
    let rows = part(rows);
    let first = tile_with(plan, rows.start);
    let last = tile_with(plan, rows.end - 1);
    Ok((first..last + 1, rows))
}

/// The tile that a row is in.
fn tile_with(plan: &Plan, row: u64) -> u64 {
    let (mut low, mut high) = (0, plan.tiles().saturating_sub(1));
    while low < high {
        let middle = low + (high - low) / 2;
        if plan.tile(middle).end > row { high = middle } else { low = middle + 1 }
    }
    low
}
