//! Native module: exports `PyInit__hrsafety` of the binding. A dynamic library is compiled only when all that it links
//! is there, so it holds nothing itself, and the binding is compiled beside the cores.

use hrsafety_py as _;
