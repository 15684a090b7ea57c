//! Base64 inside text formats: line breaks and blanks are skipped, padding may be missing.

use base64::alphabet::STANDARD;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use base64::engine::{DecodePaddingMode, Engine as _};

const LENIENT: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The decoded bytes, or a message about what is wrong.
pub(super) fn decode(text: &[u8]) -> Result<Vec<u8>, String> {
    let plain: Vec<u8> = text.iter().copied().filter(|b| !b.is_ascii_whitespace()).collect();
    LENIENT.decode(plain).map_err(|e| format!("the base64 text is damaged: {e}"))
}

/// The text of these bytes, on one line.
pub(super) fn encode(bytes: &[u8]) -> String {
    LENIENT.encode(bytes)
}
