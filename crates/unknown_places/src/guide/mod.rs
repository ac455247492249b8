//! Time to the goal from every place of a rolling map; what is unknown can be passed, at a price.

mod buckets;
mod search;
mod time_to_go;

pub use search::{GuideOptions, Progress, Search, Size};
pub use time_to_go::{Outlook, TimeToGo};
