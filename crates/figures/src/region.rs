//! The area that lines enclose and given places lie in, as cells of a picture.

use crate::palette::Color;
use crate::placement::Rect;
use crate::scene::{Picture, Point};

/// Cells a point of the page.
const FINE: f64 = 2.0;
/// The widest gap between the ends of lines that is taken for closed, cells on either side.
const MOST_GAP: usize = 4;

/// Which cells lie inside: those that are joined to a place of `inside` without crossing `walls`. `None` where nothing lies inside,
/// or where the walls do not part a place from the edge of `frame`: then what is inside is not known.
pub(crate) fn inside(walls: &[Vec<Point>], inside: &[Point], frame: Rect, color: Color) -> Option<Picture> {
    let grid = Grid::new(frame);
    let lines = grid.walls(walls);
    (0..=MOST_GAP).find_map(|gap| {
        let walls = grid.grown(&lines, gap);
        let outside = grid.flood(&walls, grid.edge());
        let seeds: Vec<usize> =
            inside.iter().filter_map(|place| grid.cell(*place)).filter(|cell| !walls[*cell]).collect();
        if seeds.is_empty() || seeds.iter().any(|cell| outside[*cell]) {
            return None;
        }
        let mut found = grid.flood(&walls, seeds);
        // Up to the middle of the lines, which are drawn over it.
        for _ in 0..gap + 3 {
            let wider = grid.grown(&found, 1);
            found = wider.iter().zip(&walls).zip(&found).map(|((wide, wall), own)| *own || (*wide && *wall)).collect();
        }
        Some(grid.picture(&found, color))
    })
}

struct Grid {
    frame: Rect,
    width: usize,
    height: usize,
}

impl Grid {
    fn new(frame: Rect) -> Self {
        Self { frame, width: cells(frame.width()), height: cells(frame.height()) }
    }

    fn cell(&self, [x, y]: Point) -> Option<usize> {
        let (x, y) = ((x - self.frame.left) * FINE, (y - self.frame.top) * FINE);
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        let (column, line) = (whole(x), whole(y));
        (column < self.width && line < self.height).then_some(line * self.width + column)
    }

    /// Cells on lines, joined by their sides or corners.
    fn walls(&self, lines: &[Vec<Point>]) -> Vec<bool> {
        let mut found = vec![false; self.width * self.height];
        for pair in lines.iter().flat_map(|line| line.windows(2)) {
            let [a, b] = [pair[0], pair[1]];
            // Half a cell a step, and never more steps than cross the page.
            let most = self.width + self.height;
            let steps = whole((b[0] - a[0]).hypot(b[1] - a[1]) * FINE * 2.0).clamp(1, 4 * most);
            for step in 0..=steps {
                let fraction = step as f64 / steps as f64;
                let at = [0, 1].map(|k| a[k] + fraction * (b[k] - a[k]));
                if let Some(cell) = self.cell(at) {
                    found[cell] = true;
                }
            }
        }
        found
    }

    fn edge(&self) -> Vec<usize> {
        let all = 0..self.width * self.height;
        let at_edge = |cell: &usize| {
            let (line, column) = (cell / self.width, cell % self.width);
            line == 0 || column == 0 || line + 1 == self.height || column + 1 == self.width
        };
        all.filter(at_edge).collect()
    }

    /// Cells that share a side with this one.
    fn beside(&self, cell: usize) -> impl Iterator<Item = usize> {
        let (line, column) = (cell / self.width, cell % self.width);
        let (width, height) = (self.width, self.height);
        [
            (column > 0).then(|| cell - 1),
            (column + 1 < width).then_some(cell + 1),
            (line > 0).then(|| cell - width),
            (line + 1 < height).then_some(cell + width),
        ]
        .into_iter()
        .flatten()
    }

    /// All cells that are joined to `from` by sides, without walls.
    fn flood(&self, walls: &[bool], from: Vec<usize>) -> Vec<bool> {
        let mut found = vec![false; walls.len()];
        let mut next = from;
        while let Some(cell) = next.pop() {
            if found[cell] || walls[cell] {
                continue;
            }
            found[cell] = true;
            next.extend(self.beside(cell).filter(|other| !found[*other]));
        }
        found
    }

    /// With the cells around each, `times` over.
    fn grown(&self, cells: &[bool], times: usize) -> Vec<bool> {
        let mut found = cells.to_vec();
        for _ in 0..times {
            let before = found.clone();
            for cell in (0..before.len()).filter(|cell| before[*cell]) {
                for other in self.beside(cell) {
                    found[other] = true;
                }
            }
        }
        found
    }

    fn picture(&self, found: &[bool], color: Color) -> Picture {
        let [r, g, b] = color.rgb;
        let rgba = found.iter().flat_map(|there| if *there { [r, g, b, 255] } else { [0; 4] }).collect();
        Picture { width: self.width, height: self.height, rgba }
    }
}

fn cells(points: f64) -> usize {
    whole(points * FINE).max(1)
}

fn whole(value: f64) -> usize {
    const MOST: f64 = 1e5;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 100 000")]
    let whole = value.clamp(0.0, MOST).floor() as usize;
    whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::series;

    const FRAME: Rect = Rect { left: 10.0, top: 20.0, right: 60.0, bottom: 70.0 };

    fn filled(walls: &[Vec<Point>], places: &[Point]) -> Option<f64> {
        let picture = inside(walls, places, FRAME, series(0))?;
        let there = picture.rgba.chunks_exact(4).filter(|cell| cell[3] > 0).count();
        Some(there as f64 / (FINE * FINE))
    }

    fn square(from: Point, side: f64) -> Vec<Point> {
        let [x, y] = from;
        vec![from, [x + side, y], [x + side, y + side], [x, y + side], from]
    }

    #[test]
    fn the_part_with_a_place_is_filled() {
        let walls = [square([20.0, 30.0], 20.0), square([45.0, 55.0], 10.0)];
        let area = filled(&walls, &[[25.0, 35.0]]).unwrap();
        assert!((area - 400.0).abs() < 45.0, "{area}");
        let both = filled(&walls, &[[25.0, 35.0], [50.0, 60.0]]).unwrap();
        assert!((both - 500.0).abs() < 70.0, "{both}");
        // A line across, and places on one side of it alone.
        let parted = [square([20.0, 30.0], 20.0), vec![[30.0, 30.0], [30.0, 50.0]]];
        let half = filled(&parted, &[[25.0, 35.0]]).unwrap();
        assert!((half - 200.0).abs() < 35.0, "{half}");
    }

    #[test]
    fn lines_with_a_small_gap_are_closed_and_others_are_not() {
        let open = |gap: f64| vec![vec![[20.0 + gap, 30.0], [40.0, 30.0], [40.0, 50.0], [20.0, 50.0], [20.0, 30.0]]];
        assert!(filled(&open(2.0), &[[30.0, 40.0]]).unwrap() > 300.0);
        assert!(filled(&open(15.0), &[[30.0, 40.0]]).is_none());
        assert!(filled(&[], &[[30.0, 40.0]]).is_none() && filled(&open(0.0), &[]).is_none());
        assert!(filled(&[vec![[f64::NAN; 2], [1e300, 5.0]]], &[[f64::INFINITY, 0.0]]).is_none());
    }
}
