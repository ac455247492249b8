//! A step along a curve of two numbers: the explicit pair of order 8 with errors of orders 5 and 3 of Hairer,
//! Norsett and Wanner (1993), known as DOP853.

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

/// Steps between evaluations of the rates.
pub const EVALUATIONS: usize = 11;

/// State after a step of some length, and its error over the scales.
#[inline]
pub fn step(
    rates: impl Fn(f64, [f64; 2]) -> [f64; 2],
    (at, state, first): (f64, [f64; 2], [f64; 2]),
    length: f64,
    scales: [f64; 2],
) -> ([f64; 2], f64) {
    let mut slopes = [[0.0; 2]; 12];
    slopes[0] = first;
    for (index, (weights, node)) in STAGES.iter().zip(NODES).enumerate() {
        let mut sum = [0.0; 2];
        for &(place, weight) in *weights {
            sum[0] += weight * slopes[place][0];
            sum[1] += weight * slopes[place][1];
        }
        let inner = [state[0] + length * sum[0], state[1] + length * sum[1]];
        slopes[index + 1] = rates(at + node * length, inner);
    }
    let mut sums = [[0.0; 2]; 3];
    for (place, weights) in RESULT {
        for (sum, weight) in sums.iter_mut().zip(weights) {
            sum[0] += weight * slopes[place][0];
            sum[1] += weight * slopes[place][1];
        }
    }
    let [result, third, fifth] = sums;
    let square = |error: [f64; 2]| {
        let [first, second] = [error[0] / scales[0], error[1] / scales[1]];
        first * first + second * second
    };
    let (low, high) = (square(third), square(fifth));
    // The smaller error of order 5 counts by its share of both.
    let error = if high == 0.0 {
        0.0
    } else {
        length.abs() * high / (high + 0.01 * low).sqrt()
    };
    (
        [state[0] + length * result[0], state[1] + length * result[1]],
        error,
    )
}

#[cfg(test)]
mod tests {
    use super::step;

    /// A quarter of a circle in steps of equal length.
    fn turned(count: u32) -> ([f64; 2], f64) {
        let rates = |_, [x, y]: [f64; 2]| [-y, x];
        let length = std::f64::consts::FRAC_PI_2 / f64::from(count);
        let (mut state, mut worst) = ([1.0, 0.0], 0.0_f64);
        for _ in 0..count {
            let first = rates(0.0, state);
            let (next, error) = step(rates, (0.0, state, first), length, [1.0; 2]);
            worst = worst.max(error);
            state = next;
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
        let (state, _) = step(rates, (0.0, [0.0; 2], [0.0; 2]), 1.0, [1.0; 2]);
        assert!((state[0] - 1.0).abs() < 1e-13 && (state[1] - 1.0).abs() < 1e-13);
    }
}
