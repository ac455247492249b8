//! Laws that act pair by pair with all their gains, named here only: a new gain is zero in every test
//! that does not set it.

use vff_core::laws::{BorensteinKoren, GeCui, Khatib, KhatibForm, Masoud};

pub const MASOUD: Masoud = Masoud {
    attractive: 5.0,
    repulsive: 24.0,
    detour: 36.0,
};

pub const GE_CUI: GeCui = GeCui {
    attractive: 1.0,
    repulsive: 14.2,
    ratio: 0.75,
    max_deceleration: 10.0,
};

pub const KHATIB: Khatib = Khatib {
    attractive: 3.0,
    repulsive: 0.5,
    ratio: 1.0,
    form: KhatibForm::Gradient,
};

pub const BORENSTEIN_KOREN: BorensteinKoren = BorensteinKoren {
    attractive: 4.0,
    repulsive: 0.7,
    attracted_inside: true,
};
