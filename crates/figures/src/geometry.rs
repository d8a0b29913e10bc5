//! Places on the page, and the pieces of paths.

/// A place on the page: points (1/72 inch) from its left and upper edge.
pub(crate) type Point = [f64; 2];

/// A piece of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Segment {
    Move(Point),
    Line(Point),
    /// Control point, end.
    Quad(Point, Point),
    Close,
}
