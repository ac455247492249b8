//! A step along a curve of two numbers: the explicit pair of order 8 with errors of orders 5 and 3 of Hairer,
//! Norsett and Wanner (1993), known as DOP853.

use numeric::lanes::Real;

/// Nodes of the stages after the first one.
const NODES: [f64; 11] = [
    0.052_600_151_958_767_73,
    0.078_900_227_938_151_6,
    0.118_350_341_907_227_4,
    0.281_649_658_092_772_6,
    1.0 / 3.0,
    0.25,
    4.0 / 13.0,
    0.651_282_051_282_051_3,
    0.6,
    6.0 / 7.0,
    1.0,
];
/// Weights of the stages before each of them, with the places of these stages.
#[rustfmt::skip]
#[allow(clippy::unreadable_literal)] // weights as the book prints them, rounded
const STAGES: [&[(usize, f64)]; 11] = [
    &[(0, 0.05260015195876773)],
    &[(0, 0.0197250569845379), (1, 0.0591751709536137)],
    &[(0, 0.02958758547680685), (2, 0.08876275643042054)],
    &[(0, 0.2413651341592667), (2, -0.8845494793282861), (3, 0.924834003261792)],
    &[(0, 0.037037037037037035), (3, 0.17082860872947386), (4, 0.12546768756682242)],
    &[(0, 0.037109375), (3, 0.17025221101954405), (4, 0.06021653898045596), (5, -0.017578125)],
    &[(0, 0.03709200011850479), (3, 0.17038392571223998), (4, 0.10726203044637328), (5, -0.015319437748624402), (6, 0.008273789163814023)],
    &[(0, 0.6241109587160757), (3, -3.3608926294469414), (4, -0.868219346841726), (5, 27.59209969944671), (6, 20.154067550477894), (7, -43.48988418106996)],
    &[(0, 0.47766253643826434), (3, -2.4881146199716677), (4, -0.590290826836843), (5, 21.230051448181193), (6, 15.279233632882423), (7, -33.28821096898486), (8, -0.020331201708508627)],
    &[(0, -0.9371424300859873), (3, 5.186372428844064), (4, 1.0914373489967295), (5, -8.149787010746927), (6, -18.52006565999696), (7, 22.739487099350505), (8, 2.4936055526796523), (9, -3.0467644718982196)],
    &[(0, 2.273310147516538), (3, -10.53449546673725), (4, -2.0008720582248625), (5, -17.9589318631188), (6, 27.94888452941996), (7, -2.8589982771350235), (8, -8.87285693353063), (9, 12.360567175794303), (10, 0.6433927460157636)],
];
/// Stages that count at the end, with their weights in the result and in the errors of orders 3 and 5.
#[rustfmt::skip]
#[allow(clippy::unreadable_literal)] // likewise
const RESULT: [(usize, [f64; 3]); 8] = [
    (0, [0.054293734116568765, -0.18980075407240762, 0.01312004499419488]),
    (5, [4.450312892752409, 4.450312892752409, -1.2251564463762044]),
    (6, [1.8915178993145003, 1.8915178993145003, -0.4957589496572502]),
    (7, [-5.801203960010585, -5.801203960010585, 1.6643771824549864]),
    (8, [0.3111643669578199, -0.4226823213237919, -0.35032884874997366]),
    (9, [-0.1521609496625161, -0.1521609496625161, 0.3341791187130175]),
    (10, [0.20136540080403034, 0.20136540080403034, 0.08192320648511571]),
    (11, [0.04471061572777259, 0.02265179219836082, -0.022355307863886294]),
];

/// Evaluations of the rates in a step.
pub const EVALUATIONS: usize = 11;

/// Nodes of three more stages, after the end of a step, and their weights, for what is within it.
const INNER_NODES: [f64; 3] = [0.1, 0.2, 7.0 / 9.0];
#[rustfmt::skip]
#[allow(clippy::unreadable_literal)] // likewise
const INNER_STAGES: [&[(usize, f64)]; 3] = [
    &[(0, 0.056167502283047954), (6, 0.25350021021662483), (7, -0.2462390374708025), (8, -0.12419142326381637), (9, 0.15329179827876568), (10, 0.00820105229563469), (11, 0.007567897660545699), (12, -0.008298)],
    &[(0, 0.03183464816350214), (5, 0.028300909672366776), (6, 0.053541988307438566), (7, -0.05492374857139099), (10, -0.00010834732869724932), (11, 0.0003825710908356584), (12, -0.00034046500868740456), (13, 0.1413124436746325)],
    &[(0, -0.42889630158379194), (5, -4.697621415361164), (6, 7.683421196062599), (7, 4.06898981839711), (8, 0.3567271874552811), (12, -0.0013990241651590145), (13, 2.9475147891527724), (14, -9.15095847217987)],
];
/// Weights of the stages in the upper terms of the polynomial of order 7 within a step.
#[rustfmt::skip]
#[allow(clippy::unreadable_literal)] // likewise
const INNER: [(usize, [f64; 4]); 12] = [
    (0, [-8.428938276109013, 10.427508642579134, 19.985053242002433, -25.69393346270375]),
    (5, [0.5667149535193777, 242.28349177525817, -387.0373087493518, -154.18974869023643]),
    (6, [-3.0689499459498917, 165.20045171727028, -189.17813819516758, -231.5293791760455]),
    (7, [2.38466765651207, -374.5467547226902, 527.8081592054236, 357.6391179106141]),
    (8, [2.117034582445028, -22.113666853125306, -11.57390253995963, 93.40532418362432]),
    (9, [-0.871391583777973, 7.733432668472264, 6.8812326946963, -37.45832313645163]),
    (10, [2.2404374302607883, -30.674084731089398, -1.0006050966910838, 104.0996495089623]),
    (11, [0.6315787787694688, -9.332130526430229, 0.7777137798053443, 29.8402934266605]),
    (12, [-0.08899033645133331, 15.697238121770845, -2.778205752353508, -43.53345659001114]),
    (13, [18.148505520854727, -31.139403219565178, -60.19669523126412, 96.32455395918828]),
    (14, [-9.194632392478356, -9.35292435884448, 84.32040550667716, -39.17726167561544]),
    (15, [-4.436036387594894, 35.81684148639408, 11.99229113618279, -149.72683625798564]),
];

/// A step that was taken.
pub struct CurveStep {
    from: [f64; 2],
    /// Its length.
    pub length: f64,
    slopes: [[f64; 2]; 12],
    /// State at its end.
    pub state: [f64; 2],
}

/// Steps of curves side by side.
#[derive(Clone, Copy)]
pub struct Steps<R> {
    from: [R; 2],
    length: R,
    slopes: [[R; 2]; 12],
    state: [R; 2],
    error: R,
}

impl<R: Real> Steps<R> {
    /// None yet.
    pub fn none() -> Self {
        Self {
            from: [R::zero(); 2],
            length: R::zero(),
            slopes: [[R::zero(); 2]; 12],
            state: [R::zero(); 2],
            error: R::zero(),
        }
    }

    /// The steps in more lanes; the last one stands for those beyond it.
    pub fn widened<W: Real>(&self) -> Steps<W> {
        let of = |number: R| W::from_fn(|lane| number.lane(lane.min(R::WIDTH - 1)));
        let both = |[first, second]: [R; 2]| [of(first), of(second)];
        Steps {
            from: both(self.from),
            length: of(self.length),
            slopes: self.slopes.map(both),
            state: both(self.state),
            error: of(self.error),
        }
    }

    /// State at the end of one curve's step, and its error over the scales.
    pub fn end(&self, lane: usize) -> ([f64; 2], f64) {
        let state = self.state.map(|number| number.lane(lane));
        (state, self.error.lane(lane))
    }

    /// The step of one curve.
    pub fn lane(&self, lane: usize) -> CurveStep {
        let of = |pair: [R; 2]| pair.map(|number| number.lane(lane));
        CurveStep {
            from: of(self.from),
            length: self.length.lane(lane),
            slopes: self.slopes.map(of),
            state: of(self.state),
        }
    }

    /// Takes steps of some lengths.
    #[inline(always)]
    pub fn take(
        &mut self,
        rates: impl Fn(R, [R; 2]) -> [R; 2],
        (at, state, first): (R, [R; 2], [R; 2]),
        length: R,
        scales: [R; 2],
    ) {
        (self.from, self.length) = (state, length);
        let slopes = &mut self.slopes;
        slopes[0] = first;
        for (index, (weights, node)) in STAGES.iter().zip(NODES).enumerate() {
            let inner = moved(state, length, weights, slopes);
            slopes[index + 1] = rates(at + R::splat(node) * length, inner);
        }
        let mut sums = [[R::zero(); 2]; 3];
        for (place, weights) in RESULT {
            for (sum, weight) in sums.iter_mut().zip(weights) {
                let weight = R::splat(weight);
                sum[0] += weight * slopes[place][0];
                sum[1] += weight * slopes[place][1];
            }
        }
        let [result, third, fifth] = sums;
        let square = |error: [R; 2]| {
            let [first, second] = [error[0] / scales[0], error[1] / scales[1]];
            first * first + second * second
        };
        let (low, high) = (square(third), square(fifth));
        // The smaller error of order 5 counts by its share of both.
        let share = length.abs() * high / (high + R::splat(0.01) * low).sqrt();
        let none = high.le(R::zero()) & high.ge(R::zero());
        self.error = R::select(none, R::zero(), share);
        self.state = [state[0] + length * result[0], state[1] + length * result[1]];
    }
}

/// States moved along the slopes of some stages.
#[inline(always)]
fn moved<R: Real>(state: [R; 2], length: R, weights: &[(usize, f64)], slopes: &[[R; 2]]) -> [R; 2] {
    let mut sum = [R::zero(); 2];
    for &(place, weight) in weights {
        let weight = R::splat(weight);
        sum[0] += weight * slopes[place][0];
        sum[1] += weight * slopes[place][1];
    }
    [state[0] + length * sum[0], state[1] + length * sum[1]]
}

/// States within a step.
pub struct Inside {
    from: [f64; 2],
    terms: [[f64; 2]; 7],
}

impl Inside {
    /// Evaluations of the rates for it.
    pub const EVALUATIONS: usize = INNER_NODES.len();

    /// Of a step from some place with the rates at its end.
    pub fn of(
        rates: impl Fn(f64, [f64; 2]) -> [f64; 2],
        at: f64,
        step: &CurveStep,
        last: [f64; 2],
    ) -> Self {
        let CurveStep {
            from,
            length,
            state,
            ..
        } = *step;
        let mut slopes = [[0.0; 2]; 16];
        slopes[..12].copy_from_slice(&step.slopes);
        slopes[12] = last;
        for (index, (weights, node)) in INNER_STAGES.iter().zip(INNER_NODES).enumerate() {
            let inner = moved(from, length, weights, &slopes);
            slopes[13 + index] = rates(at + node * length, inner);
        }
        let mut terms = [[0.0; 2]; 7];
        for entry in 0..2 {
            let change = state[entry] - from[entry];
            let ends = [slopes[0][entry], last[entry]].map(|slope| length * slope);
            terms[0][entry] = change;
            terms[1][entry] = ends[0] - change;
            terms[2][entry] = 2.0 * change - (ends[1] + ends[0]);
            for (place, weights) in INNER {
                for (term, weight) in terms[3..].iter_mut().zip(weights) {
                    term[entry] += length * weight * slopes[place][entry];
                }
            }
        }
        Self { from, terms }
    }

    /// State at a share of the step, and its rates over the share.
    pub fn at(&self, share: f64) -> [[f64; 2]; 2] {
        let (mut moved, mut rates) = ([0.0; 2], [0.0; 2]);
        for (index, term) in self.terms.iter().enumerate().rev() {
            let (factor, change) = if index % 2 == 0 {
                (share, 1.0)
            } else {
                (1.0 - share, -1.0)
            };
            for entry in 0..2 {
                let sum = moved[entry] + term[entry];
                rates[entry] = rates[entry] * factor + sum * change;
                moved[entry] = sum * factor;
            }
        }
        [[self.from[0] + moved[0], self.from[1] + moved[1]], rates]
    }
}

#[cfg(test)]
mod tests {
    use super::{Inside, Steps};

    fn step(
        rates: impl Fn(f64, [f64; 2]) -> [f64; 2],
        from: (f64, [f64; 2], [f64; 2]),
        length: f64,
    ) -> Steps<f64> {
        let mut taken = Steps::none();
        taken.take(rates, from, length, [1.0; 2]);
        taken
    }

    /// A quarter of a circle in steps of equal length.
    fn turned(count: u32) -> ([f64; 2], f64) {
        let rates = |_, [x, y]: [f64; 2]| [-y, x];
        let length = std::f64::consts::FRAC_PI_2 / f64::from(count);
        let (mut state, mut worst) = ([1.0, 0.0], 0.0_f64);
        for _ in 0..count {
            let first = rates(0.0, state);
            let taken = step(rates, (0.0, state, first), length);
            worst = worst.max(taken.error);
            state = taken.state;
        }
        (state, worst)
    }

    #[test]
    fn errors_fall_with_the_eighth_power() {
        let error = |count| {
            let (state, _) = turned(count);
            state[0].hypot(state[1] - 1.0)
        };
        let order = (error(1) / error(2)).log2();
        assert!((7.0..10.0).contains(&order), "{order}");
        assert!(error(4) < 1e-10);
    }

    #[test]
    fn an_estimate_is_above_the_error() {
        let (state, estimate) = turned(1);
        let error = state[0].hypot(state[1] - 1.0);
        assert!(
            estimate > error && estimate < 1e4 * error,
            "{estimate:e} {error:e}"
        );
    }

    #[test]
    fn a_right_side_of_the_variable_alone_is_integrated() {
        let rates = |x: f64, _: [f64; 2]| [8.0 * x.powi(7), 3.0 * x * x];
        let taken = step(rates, (0.0, [0.0; 2], [0.0; 2]), 1.0);
        let state = taken.state;
        assert!((state[0] - 1.0).abs() < 1e-13 && (state[1] - 1.0).abs() < 1e-13);
    }

    #[test]
    fn states_within_a_step_are_of_order_seven() {
        let rates = |_, [x, y]: [f64; 2]| [-y, x];
        let error = |length: f64| {
            let from = [1.0, 0.0];
            let taken = step(rates, (0.0, from, rates(0.0, from)), length).lane(0);
            let inside = Inside::of(rates, 0.0, &taken, rates(length, taken.state));
            assert_eq!(inside.at(0.0)[0], from);
            assert!((inside.at(1.0)[0][0] - taken.state[0]).abs() < 1e-15);
            assert!((inside.at(1.0)[1][0] + length * taken.state[1]).abs() < 1e-15);
            let off = |k: u32| {
                let share = f64::from(k) / 8.0;
                let [[x, y], [over_x, over_y]] = inside.at(share);
                let (sine, cosine) = (share * length).sin_cos();
                let defect = (over_x + length * y).hypot(over_y - length * x);
                let error = (x - cosine).hypot(y - sine);
                assert!(error < 2.0 * defect, "{defect:e} {error:e}");
                error
            };
            (1..8).map(off).fold(0.0, f64::max)
        };
        let order = (error(1.0) / error(0.5)).log2();
        assert!((7.0..9.5).contains(&order), "{order}");
        assert!(error(0.5) < 1e-8);
    }
}
