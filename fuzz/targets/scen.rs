#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| (hyperplan_tests::fuzz::SCEN.body)(data));
