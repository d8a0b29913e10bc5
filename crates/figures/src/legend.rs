//! Samples and their meaning, in rows above the frame where no data are.

use crate::axes::{LEFT, TEXT_SIZE};
use crate::font::{CAP_HEIGHT, Label};
use crate::page::{LINE, Page};
use crate::palette::{Color, PAPER};
use crate::scene::{Anchor, Point, Scene, Stroke};

/// What a legend shows.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Sample {
    Line(Stroke),
    Mark(Mark),
    /// An area.
    Fill(Color),
}

/// A point of a chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Mark {
    Filled(Color),
    Hollow(Color),
    /// A square on its corner, hollow.
    Diamond(Color),
    Cross(Color),
    Square(Color),
}

impl Mark {
    pub(crate) fn draw(self, scene: &mut Scene, [x, y]: Point) {
        const SIZE: f64 = 2.3;
        match self {
            Self::Filled(color) => scene.dot([x, y], SIZE, color),
            Self::Hollow(color) => scene.ring([x, y], SIZE - 0.4, Stroke::solid(color, 0.8)),
            Self::Diamond(color) => {
                let a = 1.5 * SIZE;
                let corners = [[x - a, y], [x, y - a], [x + a, y], [x, y + a]];
                scene.area(&corners, Some(PAPER), Some(Stroke::solid(color, 0.9)));
            }
            Self::Square(color) => {
                let a = 1.6 * SIZE;
                scene.area(&[[x - a, y - a], [x + a, y - a], [x + a, y + a], [x - a, y + a]], Some(color), None);
            }
            Self::Cross(color) => {
                let a = 1.2 * SIZE;
                scene.line(&[[x - a, y - a], [x + a, y + a]], Stroke::solid(color, 1.2));
                scene.line(&[[x - a, y + a], [x + a, y - a]], Stroke::solid(color, 1.2));
            }
        }
    }
}

/// Entries in the order in which they are read: of what is drawn, and of nothing else.
#[derive(Debug)]
pub(crate) struct Legend {
    entries: Vec<(Sample, Label)>,
    /// The right edge.
    right: f64,
}

const SAMPLE: f64 = 18.0;
/// From a sample to its label, and from that to the next sample.
const GAPS: [f64; 2] = [4.0, 16.0];

impl Legend {
    pub(crate) fn new(page: &Page) -> Self {
        Self { entries: Vec::new(), right: page.right() }
    }

    pub(crate) fn add(&mut self, sample: Sample, label: Label) {
        self.entries.push((sample, label));
    }

    /// Where each entry goes, from the upper left corner, and the height of all.
    fn places(&self) -> (Vec<Point>, f64) {
        let (mut x, mut y) = (LEFT, LINE - 2.0);
        let mut out = Vec::new();
        for (_, label) in &self.entries {
            let width = SAMPLE + GAPS[0] + label.width(TEXT_SIZE);
            if x > LEFT && x + width > self.right {
                x = LEFT;
                y += LINE;
            }
            out.push([x, y]);
            x += width + GAPS[1];
        }
        let height = if out.is_empty() { 0.0 } else { y + 2.0 };
        (out, height)
    }

    pub(crate) fn height(&self) -> f64 {
        self.places().1
    }

    /// Draws the entries below `top`.
    pub(crate) fn draw(&self, scene: &mut Scene, top: f64) {
        for ((sample, label), [x, y]) in self.entries.iter().zip(self.places().0) {
            let baseline = top + y;
            let middle = baseline - 0.5 * CAP_HEIGHT * TEXT_SIZE;
            match *sample {
                Sample::Line(stroke) => scene.line(&[[x, middle], [x + SAMPLE, middle]], stroke),
                Sample::Mark(mark) => mark.draw(scene, [x + 0.5 * SAMPLE, middle]),
                Sample::Fill(color) => {
                    let half = 0.5 * CAP_HEIGHT * TEXT_SIZE;
                    let corner = |across: f64, down: f64| [x + across * SAMPLE, middle + down * half];
                    let corners = [corner(0.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(0.0, 1.0)];
                    scene.area(&corners, Some(color), None);
                }
            }
            scene.text(label, [x + SAMPLE + GAPS[0], baseline], Anchor::Start, TEXT_SIZE);
        }
    }
}

/// A name at the length that a legend can bear.
pub(crate) fn clipped(name: &str) -> String {
    const MOST: usize = 40;
    if name.chars().count() <= MOST {
        return name.to_owned();
    }
    name.chars().take(MOST).chain(['.', '.', '.']).collect()
}
