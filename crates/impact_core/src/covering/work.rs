//! Work stored by a covering, at one compression or at several side by side.

use numeric::lanes::{Real, Truth, each};

use super::{Covering, Pad, Shape};

impl Pad {
    /// Work that is stored at a compression.
    #[must_use]
    pub fn work(&self, compression: f64) -> f64 {
        let Covering {
            material,
            thickness,
            shape,
            bottoming,
            ..
        } = &self.covering;
        if compression <= 0.0 {
            return 0.0;
        }
        let strain = compression / thickness;
        let value = match (shape, &self.halves) {
            (Shape::Cylinder { .. }, Some(halves)) => halves.work(material, strain),
            (Shape::Curved { .. }, _) => material.work_integral(strain),
            _ => material.work(strain),
        };
        let backing = (compression - self.bottom).max(0.0);
        self.scale * thickness * value + 0.5 * bottoming.stiffness * backing * backing
    }

    /// Work that is stored at compressions side by side.
    #[inline(always)]
    #[must_use]
    pub fn works<R: Real>(&self, compression: R) -> R {
        let none = compression.le(R::zero()).any();
        if let Some(powers) = self.powers
            && !self.is_flat()
            && !none
        {
            let thickness = R::splat(self.covering.thickness);
            let [work, ..] = powers.works(compression / thickness);
            return thickness * work + self.backing(compression)[0];
        }
        if !self.is_flat() || none {
            return R::from_fn(|lane| self.work(compression.lane(lane)));
        }
        let thickness = self.covering.thickness;
        let work = self
            .covering
            .material
            .works(compression / R::splat(thickness));
        R::splat(self.scale * thickness) * work + self.backing(compression)[0]
    }

    /// Work, force and slope of the force at compressions side by side.
    #[inline(always)]
    #[must_use]
    pub fn work_and_force<R: Real>(&self, compression: R) -> [R; 3] {
        let none = compression.le(R::zero()).any();
        if let Some(powers) = self.powers
            && !self.is_flat()
            && !none
        {
            let thickness = R::splat(self.covering.thickness);
            let [work, force, slope] = powers.works(compression / thickness);
            let [stored, more, stiffness] = self.backing(compression);
            return [
                thickness * work + stored,
                force + more,
                slope / thickness + stiffness,
            ];
        }
        if !self.is_flat() || none {
            return each(compression, |compression| {
                let [force, slope] = self.force(compression);
                [self.work(compression), force, slope]
            });
        }
        let (scale, thickness) = (self.scale, R::splat(self.covering.thickness));
        let material = &self.covering.material;
        let [work, stress, slope] = material.work_and_stress(compression / thickness);
        let [stored, force, stiffness] = self.backing(compression);
        [
            R::splat(scale) * thickness * work + stored,
            R::splat(scale) * stress + force,
            R::splat(scale) * slope / thickness + stiffness,
        ]
    }

    /// Work, force and slope of the backing.
    #[inline(always)]
    fn backing<R: Real>(&self, compression: R) -> [R; 3] {
        let (zero, bottom) = (R::zero(), R::splat(self.bottom));
        let beyond = compression.gt(bottom);
        if !beyond.any() {
            return [zero; 3];
        }
        let stiffness = R::select(beyond, R::splat(self.covering.bottoming.stiffness), zero);
        let depth = compression - bottom;
        [
            R::splat(0.5) * stiffness * depth * depth,
            stiffness * depth,
            stiffness,
        ]
    }

    fn is_flat(&self) -> bool {
        matches!(self.covering.shape, Shape::Flat { .. })
    }
}
