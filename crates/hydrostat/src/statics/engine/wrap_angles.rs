//! How far cables turn along the solution, for friction.

use super::discrete::Engine;
use crate::statics::dimensions::M;
use crate::statics::equations::SectionFailure;
use crate::statics::friction::{POINTS, WrapAngles};

impl Engine {
    /// How far the cables have turned along the solution.
    pub(crate) fn wrap_angles(&self) -> Result<WrapAngles, SectionFailure> {
        let equations = &self.equations;
        let gauss = self.system.gauss.clone();
        let mesh = &self.solution.mesh;
        let count = equations.arm().cables.len();
        let system = self.at_present();
        let stations = system.stations();
        let mut angles: Vec<Vec<[f64; POINTS]>> = vec![Vec::new(); count];
        for i in 0..mesh.elements() {
            let [left, right] = [self.sharp_beside_node(i, false)?, self.sharp_beside_node(i + 1, true)?];
            let ends = [(mesh.nodes()[i], &left, i), (mesh.nodes()[i + 1], &right, i + 1)];
            for (c, own) in angles.iter_mut().enumerate() {
                let [first, end] =
                    ends.map(|(s, at, node)| self.solution.nodes[node][0] + equations.cable_angle(c, s, at));
                let mut angles = [first; POINTS];
                for j in 0..M {
                    let (block, lane) = self.solution.groups().at(i, j);
                    angles[1 + j] = equations.cable_angle_in(c, block, &stations[block]).0[lane];
                }
                angles[POINTS - 1] = end;
                own.push(angles);
            }
        }
        let own = |s: f64| equations.jumps_at(s) || self.has_break_at(s);
        let breaks: Vec<bool> = mesh.nodes().iter().map(|s| own(*s)).collect();
        let steps: Vec<bool> = mesh.nodes().iter().map(|s| equations.jumps_at(*s)).collect();
        Ok(WrapAngles::new(gauss, mesh.nodes().to_vec(), angles, &breaks, &steps))
    }
}
