//! Samples and their meaning, in rows above the frame where no data are.

use hydrostat::{Arm, Parameter};

use crate::arm_figure::short;
use crate::axes::{LEFT, TEXT_SIZE};
use crate::font::{CAP_HEIGHT, Label};
use crate::palette::{Color, GREY, WATER};
use crate::scene::{Anchor, Point, Scene, Stroke};

/// The width of every page and what stays free at its edges, points.
pub(crate) const WIDTH: f64 = 450.0;
pub(crate) const MARGIN: f64 = 10.0;
/// Between two lines of text.
pub(crate) const LINE: f64 = 14.0;

/// What a legend shows.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Sample {
    Line(Stroke),
    /// A direction in the plane, rad.
    Arrow(f64, Color),
    Mark(Mark),
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
        const PAPER: Color = Color { rgb: [255, 255, 255], opacity: 1.0 };
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

/// Entries in the order in which they are read.
#[derive(Debug, Default)]
pub(crate) struct Legend {
    entries: Vec<(Sample, Label)>,
}

const SAMPLE: f64 = 18.0;
/// From a sample to its label, and from that to the next sample.
const GAPS: [f64; 2] = [4.0, 16.0];

impl Legend {
    pub(crate) fn add(&mut self, sample: Sample, label: Label) {
        self.entries.push((sample, label));
    }

    /// Stream and gravity, but for what varies from one shape to the other.
    pub(crate) fn add_surroundings(&mut self, arm: &Arm, varied: Option<Parameter>) {
        let flows = arm.flow.speed > 0.0 || varied == Some(Parameter::FlowSpeed);
        if flows && arm.flow.density > 0.0 && varied != Some(Parameter::FlowDirection) {
            let speed = format!("stream {} m/s", short(arm.flow.speed));
            let text = if varied == Some(Parameter::FlowSpeed) { "stream".to_owned() } else { speed };
            self.add(Sample::Arrow(arm.flow.direction, WATER), Label::plain(text));
        }
        if let Some(gravity) = &arm.gravity
            && varied != Some(Parameter::GravityDirection)
        {
            self.add(Sample::Arrow(gravity.direction, GREY), Label::plain("gravity"));
        }
    }

    /// Where each entry goes, from the upper left corner, and the height of all.
    fn places(&self) -> (Vec<Point>, f64) {
        let (mut x, mut y) = (LEFT, LINE - 2.0);
        let mut out = Vec::new();
        for (_, label) in &self.entries {
            let width = SAMPLE + GAPS[0] + label.width(TEXT_SIZE);
            if x > LEFT && x + width > WIDTH - MARGIN {
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
                Sample::Arrow(angle, color) => {
                    let (dx, dy) = (0.36 * SAMPLE * angle.cos(), -0.36 * SAMPLE * angle.sin());
                    let centre = x + 0.5 * SAMPLE;
                    scene.arrow([centre - dx, middle - dy], [centre + dx, middle + dy], color, 1.2);
                }
                Sample::Mark(mark) => mark.draw(scene, [x + 0.5 * SAMPLE, middle]),
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
