//! Other loads on the same arm, and whether they push against it.

use super::discrete::Engine;
use crate::rod::arm::Arm;
use crate::statics::dimensions::M;
use crate::statics::equations::Unloaded;
use crate::statics::friction::CapstanFactors;

impl Engine {
    /// Whether something pushes against the arm hard enough that a direct solve may have landed on a
    /// branch that the path does not lead to. Cheap and on the safe side.
    pub(crate) fn needs_continuation(&mut self) -> bool {
        if self.equations.arm().model.support == crate::Support::UnstrainedBase {
            // An initial-value problem has one solution.
            return false;
        }
        if self.system.determinant().known_sign() != Some(1.0) {
            return true;
        }
        self.system.take_stations(&self.solution);
        let stations = self.system.stations();
        let mut unloaded = Unloaded::new(&self.equations, self.equations.arm().base.angle);
        let mesh = &self.solution.mesh;
        for i in 0..mesh.elements() {
            for j in 0..M {
                let k = i * M + j;
                let mu = self.equations.reference_strain(k)[2];
                unloaded.turn(&self.equations, mesh.step(i) * self.system.gauss.b[j] * mu);
                if self.equations.buckling_indicator(k, stations, &unloaded) > 0.3 {
                    return true;
                }
            }
        }
        false
    }

    /// Whether any of the arm is nearly in line with a load.
    pub(crate) fn is_in_line(&mut self) -> bool {
        self.system.take_stations(&self.solution);
        let stations = self.system.stations();
        (0..self.equations.stations().len()).any(|k| self.equations.is_in_line(k, stations))
    }

    /// Changes loads of the arm in place.
    pub(crate) fn change_loads(&mut self, change: impl Fn(&mut Arm)) {
        self.equations.change_loads(&change);
        self.check_equations.change_loads(&change);
    }

    /// [`Engine::set_loads`] of an arm that differs in tensions, stream, weight and tip loads only.
    pub(crate) fn take_loads(&mut self, arm: &Arm) {
        let own = self.equations.arm();
        if own.gravity != arm.gravity || own.flow.density != arm.flow.density {
            self.set_loads(arm);
            return;
        }
        self.change_loads(|own| {
            for (own, cable) in own.cables.iter_mut().zip(&arm.cables) {
                own.tension = cable.tension;
                own.max_tension = cable.max_tension;
            }
            own.flow.clone_from(&arm.flow);
            own.tip.clone_from(&arm.tip);
        });
    }

    /// Takes other tensions, stream or loads for the same arm.
    pub(crate) fn set_loads(&mut self, arm: &Arm) {
        self.equations.set_loads(arm);
        self.check_equations.set_loads(arm);
    }

    /// Ends a path: `arm` stays, with all angles less by whole turns of the size `angle`.
    pub(crate) fn hold(&mut self, arm: &Arm, angle: f64) {
        self.equations.hold(arm);
        self.check_equations.hold(arm);
        for z in &mut self.solution.nodes {
            z[0] -= angle;
        }
    }

    /// What friction leaves of the tensions from now on.
    pub(crate) fn set_capstan(&mut self, capstan: Option<&CapstanFactors>) {
        self.equations.set_capstan(capstan);
        self.check_equations.set_capstan(capstan);
    }
}
