//! Anderson's acceleration of the simplified Newton iteration.
//!
//! With frozen matrices the iteration x ← x + f(x) converges linearly, and slowly where a slender rod bends much
//! within a step: what it is stiff against changes from stage to stage. Differences of iterates and of updates,
//! Δx and Δf = ∂f/∂x Δx, tell what the matrices miss. With Δf orthonormal, γ = ⟨f, Δf⟩ makes the update at
//! x − Σ γ Δx smallest (Anderson 1965; for a linear problem these are the iterates of GMRES, Walker & Ni 2011):
//!
//! ```text
//! x ← x + f − Σ γ_j (Δx_j + Δf_j)
//! ```

/// Pairs kept.
const PAIRS: usize = 20;

/// A pair that repeats the others up to this part says nothing new.
const REPEATED: f64 = 1e-6;

/// The memory of an iteration with the same matrices.
#[derive(Default)]
pub struct Secants {
    pairs: Vec<Pair>,
    /// The last f and the last step.
    last: Option<Pair>,
}

struct Pair {
    x: Vec<f64>,
    f: Vec<f64>,
}

impl Secants {
    /// Forgets everything.
    pub fn clear(&mut self) {
        self.pairs.clear();
        self.last = None;
    }

    /// f → the step to take; `weights` make the inner product ⟨a, b⟩ = Σ w a b.
    pub fn accelerate(&mut self, f: &mut [f64], weights: &[f64]) {
        let inner =
            |a: &[f64], b: &[f64]| a.iter().zip(b).zip(weights).map(|((a, b), w)| w * a * b).sum::<f64>();
        if let Some(Pair { x, f: before }) = self.last.take() {
            let mut pair = Pair { x, f: f.iter().zip(&before).map(|(now, before)| now - before).collect() };
            let norm = inner(&pair.f, &pair.f).sqrt();
            if self.pairs.len() == PAIRS {
                // The others are orthonormal without it.
                self.pairs.remove(0);
            }
            for other in &self.pairs {
                let part = inner(&pair.f, &other.f);
                add(&mut pair.x, -part, &other.x);
                add(&mut pair.f, -part, &other.f);
            }
            let rest = inner(&pair.f, &pair.f).sqrt();
            if rest > REPEATED * norm {
                pair.x.iter_mut().chain(&mut pair.f).for_each(|x| *x /= rest);
                self.pairs.push(pair);
            }
        }
        let before = f.to_vec();
        for pair in &self.pairs {
            let part = inner(&before, &pair.f);
            add(f, -part, &pair.f);
            add(f, -part, &pair.x);
        }
        self.last = Some(Pair { x: f.to_vec(), f: before });
    }
}

/// a ← a + c b.
fn add(a: &mut [f64], c: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += c * b);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x ← x + b − A x diverges for A = diag(3, ½, 1); accelerated it ends after as many steps as A has eigenvalues.
    #[test]
    fn linear_problems_are_solved_in_as_many_steps_as_there_are_eigenvalues() {
        let (a, b) = ([3.0, 0.5, 1.0], [1.0, 2.0, -1.0]);
        let mut secants = Secants::default();
        let mut x = [0.0; 3];
        for _ in 0..4 {
            let mut f: Vec<f64> = (0..3).map(|i| b[i] - a[i] * x[i]).collect();
            secants.accelerate(&mut f, &[1.0, 2.0, 1.0]);
            (0..3).for_each(|i| x[i] += f[i]);
        }
        (0..3).for_each(|i| assert!((a[i] * x[i] - b[i]).abs() < 1e-13));
    }
}
