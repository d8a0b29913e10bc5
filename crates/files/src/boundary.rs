//! The boundary of what a tip reaches, as JSON and CSV.

use hydrostat::{Arm, Boundary, BoundaryKind, BoundaryPiece, BoundaryPoint};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::results::{SCHEMA, TipOut, cell, json};
use crate::written::Inputs;

#[derive(Debug, Clone, Serialize)]
struct PointOut<'a> {
    tip: TipOut,
    tensions: &'a [f64],
}

#[derive(Debug, Clone, Serialize)]
struct PieceOut<'a> {
    kind: &'static str,
    cables: Vec<usize>,
    points: Vec<PointOut<'a>>,
}

/// The name of a kind of piece, and the cables that are between their bounds.
fn kind(piece: &BoundaryPiece) -> (&'static str, Vec<usize>) {
    match piece.kind {
        BoundaryKind::Edge(cable) => ("edge", vec![cable]),
        BoundaryKind::Fold(pair) => ("fold", pair.to_vec()),
        BoundaryKind::Limit(pair) => ("limit", pair.to_vec()),
    }
}

impl<'a> PieceOut<'a> {
    fn new(piece: &'a BoundaryPiece) -> Self {
        let (kind, cables) = kind(piece);
        let point = |p: &'a BoundaryPoint| PointOut { tip: p.tip.into(), tensions: &p.tensions };
        Self { kind, cables, points: piece.points.iter().map(point).collect() }
    }
}

/// The document of a boundary.
#[derive(Debug, Clone, Serialize)]
pub struct BoundaryDocument<'a> {
    schema: u32,
    version: &'static str,
    pieces: Vec<PieceOut<'a>>,
    inputs: Inputs,
}

impl<'a> BoundaryDocument<'a> {
    /// Of what was traced for `arm`.
    pub fn new(arm: &Arm, found: &'a Boundary) -> Self {
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            pieces: found.pieces.iter().map(PieceOut::new).collect(),
            inputs: Inputs::new(arm),
        }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

/// One row a point, pieces one after the other, for an arm with `cables` cables.
pub fn boundary_csv(cables: usize, found: &Boundary) -> String {
    let mut names = ["piece", "kind", "cables"].map(str::to_owned).to_vec();
    names.extend(["tip_x_m", "tip_y_m", "tip_theta_rad", "tip_alpha_rad"].map(str::to_owned));
    names.extend((0..cables).map(|c| format!("tension_{c}_N")));
    let mut out = Rows::new(&names);
    for (index, piece) in found.pieces.iter().enumerate() {
        let (kind, free) = kind(piece);
        let free: Vec<String> = free.iter().map(usize::to_string).collect();
        for point in &piece.points {
            let mut cells = vec![index.to_string(), kind.to_owned(), free.join(" ")];
            cells.extend([point.tip.x, point.tip.y, point.tip.theta, point.tip.alpha].map(cell));
            cells.extend(point.tensions.iter().copied().map(cell));
            out.row(&cells);
        }
    }
    out.text()
}
