//! Cases of W. Hock and K. Schittkowski, Test Examples for Nonlinear Programming Codes (1981), with
//! their published optima.

/// A case: start, box, published optimum, tolerance of the value, and cost with margins.
pub struct Case {
    pub name: &'static str,
    pub start: &'static [f64],
    pub lower: &'static [f64],
    pub upper: &'static [f64],
    pub optimum: f64,
    pub cost: fn(&[f64]) -> f64,
    pub margins: fn(&[f64]) -> Vec<f64>,
}

/// Sides of a box that the source leaves open; no optimum lies near.
const FAR: f64 = 10.0;

/// The cases.
#[allow(clippy::too_many_lines)] // a table
pub fn cases() -> Vec<Case> {
    vec![
        Case {
            name: "HS1",
            start: &[-2.0, 1.0],
            lower: &[-3.0, -1.5],
            upper: &[3.0, 4.0],
            optimum: 0.0,
            cost: |x| 100.0 * (x[1] - x[0] * x[0]).powi(2) + (1.0 - x[0]).powi(2),
            margins: |_| vec![],
        },
        Case {
            name: "HS5",
            start: &[0.0, 0.0],
            lower: &[-1.5, -3.0],
            upper: &[4.0, 3.0],
            optimum: -1.913_222_954_981_037,
            cost: |x| (x[0] + x[1]).sin() + (x[0] - x[1]).powi(2) - 1.5 * x[0] + 2.5 * x[1] + 1.0,
            margins: |_| vec![],
        },
        Case {
            name: "HS21",
            start: &[2.0, -1.0],
            lower: &[2.0, -50.0],
            upper: &[50.0, 50.0],
            optimum: -99.96,
            cost: |x| 0.01 * x[0] * x[0] + x[1] * x[1] - 100.0,
            margins: |x| vec![10.0 * x[0] - x[1] - 10.0],
        },
        Case {
            name: "HS24",
            start: &[1.0, 0.5],
            lower: &[0.0, 0.0],
            upper: &[FAR, FAR],
            optimum: -1.0,
            cost: |x| ((x[0] - 3.0).powi(2) - 9.0) * x[1].powi(3) / (27.0 * 3f64.sqrt()),
            margins: |x| {
                let root = 3f64.sqrt();
                vec![
                    x[0] / root - x[1],
                    x[0] + root * x[1],
                    6.0 - x[0] - root * x[1],
                ]
            },
        },
        Case {
            name: "HS35",
            start: &[0.5, 0.5, 0.5],
            lower: &[0.0; 3],
            upper: &[FAR; 3],
            optimum: 1.0 / 9.0,
            cost: |x| {
                9.0 - 8.0 * x[0] - 6.0 * x[1] - 4.0 * x[2]
                    + 2.0 * x[0] * x[0]
                    + 2.0 * x[1] * x[1]
                    + x[2] * x[2]
                    + 2.0 * x[0] * x[1]
                    + 2.0 * x[0] * x[2]
            },
            margins: |x| vec![3.0 - x[0] - x[1] - 2.0 * x[2]],
        },
        Case {
            name: "HS43",
            start: &[0.0; 4],
            lower: &[-FAR; 4],
            upper: &[FAR; 4],
            optimum: -44.0,
            cost: |x| {
                x[0] * x[0] + x[1] * x[1] + 2.0 * x[2] * x[2] + x[3] * x[3]
                    - 5.0 * x[0]
                    - 5.0 * x[1]
                    - 21.0 * x[2]
                    + 7.0 * x[3]
            },
            margins: |x| {
                let squares = [0, 1, 2, 3].map(|axis: usize| x[axis] * x[axis]);
                let sum: f64 = squares.iter().sum();
                vec![
                    8.0 - sum - x[0] + x[1] - x[2] + x[3],
                    10.0 - sum - squares[1] - squares[3] + x[0] + x[3],
                    5.0 - 2.0 * squares[0] - squares[1] - squares[2] - 2.0 * x[0] + x[1] + x[3],
                ]
            },
        },
        Case {
            name: "HS65",
            start: &[-4.0, 4.0, 0.5],
            lower: &[-4.5, -4.5, -5.0],
            upper: &[4.5, 4.5, 5.0],
            optimum: 0.953_528_856_757_5,
            cost: |x| {
                (x[0] - x[1]).powi(2) + (x[0] + x[1] - 10.0).powi(2) / 9.0 + (x[2] - 5.0).powi(2)
            },
            margins: |x| vec![48.0 - x[0] * x[0] - x[1] * x[1] - x[2] * x[2]],
        },
        Case {
            // The equality as two inequalities.
            name: "HS71",
            start: &[1.0, 5.0, 5.0, 1.0],
            lower: &[1.0; 4],
            upper: &[5.0; 4],
            optimum: 17.014_017_3,
            cost: |x| x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2],
            margins: |x| {
                let sum: f64 = x.iter().map(|value| value * value).sum();
                vec![x[0] * x[1] * x[2] * x[3] - 25.0, sum - 40.0, 40.0 - sum]
            },
        },
        Case {
            name: "HS76",
            start: &[0.5; 4],
            lower: &[0.0; 4],
            upper: &[FAR; 4],
            optimum: -4.681_818_181_818_18,
            cost: |x| {
                x[0] * x[0] + 0.5 * x[1] * x[1] + x[2] * x[2] + 0.5 * x[3] * x[3] - x[0] * x[2]
                    + x[2] * x[3]
                    - x[0]
                    - 3.0 * x[1]
                    + x[2]
                    - x[3]
            },
            margins: |x| {
                vec![
                    5.0 - x[0] - 2.0 * x[1] - x[2] - x[3],
                    4.0 - 3.0 * x[0] - x[1] - 2.0 * x[2] + x[3],
                    x[1] + 4.0 * x[2] - 1.5,
                ]
            },
        },
        Case {
            name: "HS100",
            start: &[1.0, 2.0, 0.0, 4.0, 0.0, 1.0, 1.0],
            lower: &[-FAR; 7],
            upper: &[FAR; 7],
            optimum: 680.630_057_3,
            cost: |x| {
                (x[0] - 10.0).powi(2)
                    + 5.0 * (x[1] - 12.0).powi(2)
                    + x[2].powi(4)
                    + 3.0 * (x[3] - 11.0).powi(2)
                    + 10.0 * x[4].powi(6)
                    + 7.0 * x[5] * x[5]
                    + x[6].powi(4)
                    - 4.0 * x[5] * x[6]
                    - 10.0 * x[5]
                    - 8.0 * x[6]
            },
            margins: |x| {
                vec![
                    127.0
                        - 2.0 * x[0] * x[0]
                        - 3.0 * x[1].powi(4)
                        - x[2]
                        - 4.0 * x[3] * x[3]
                        - 5.0 * x[4],
                    282.0 - 7.0 * x[0] - 3.0 * x[1] - 10.0 * x[2] * x[2] - x[3] + x[4],
                    196.0 - 23.0 * x[0] - x[1] * x[1] - 6.0 * x[5] * x[5] + 8.0 * x[6],
                    -4.0 * x[0] * x[0] - x[1] * x[1] + 3.0 * x[0] * x[1]
                        - 2.0 * x[2] * x[2]
                        - 5.0 * x[5]
                        + 11.0 * x[6],
                ]
            },
        },
    ]
}
