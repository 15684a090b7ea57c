//! Single values in archives, and contents that are none.

use super::*;
use std::sync::Arc;

enum Weekday {
    Monday,
    Tuesday,
}
stored!(variants Weekday { Monday = 0, Tuesday = 1 });

/// A value that is written and read again.
fn again<T: Stored>(value: &T) -> T {
    let mut writer = ArchiveWriter::default();
    value.write(&mut writer);
    assert!(writer.bytes.len() >= T::LEAST);
    let mut reader = ArchiveReader::new(&writer.bytes, 0, "test");
    let value = T::read(&mut reader).unwrap();
    assert_eq!(reader.left(), 0);
    value
}

#[test]
fn doubles_keep_every_bit() {
    let odd = [-0.0, f64::INFINITY, 5e-324, f64::from_bits(0x7ff8_0000_dead_beef), 0.1];
    assert_eq!(again(&odd.to_vec()).iter().map(|x| x.to_bits()).collect::<Vec<_>>(), odd.map(f64::to_bits));
}

#[test]
fn shared_objects_stay_shared() {
    let one = Arc::new(vec![1u32, 2]);
    let [a, b] = again(&[one.clone(), one]);
    assert!(Arc::ptr_eq(&a, &b));
    let apart = [Arc::new(String::from("x")), Arc::new(String::from("x"))];
    let [a, b] = again(&apart);
    assert!(!Arc::ptr_eq(&a, &b) && a == b);
}

#[test]
fn counts_that_do_not_fit_take_no_memory() {
    let mut bytes = u64::MAX.to_le_bytes().to_vec();
    bytes.extend([0; 16]);
    let read = |bytes: &[u8]| Vec::<Vec<f64>>::read(&mut ArchiveReader::new(bytes, 0, "test")).unwrap_err();
    assert!(read(&bytes).to_string().contains("elements do not fit into the 16 bytes that are left"));
    bytes[..8].copy_from_slice(&(1u64 << 61).to_le_bytes());
    assert!(read(&bytes).to_string().contains("do not fit"));
}

#[test]
fn values_out_of_range_are_refused() {
    fn refused<T: Stored>(bytes: &[u8]) -> String {
        T::read(&mut ArchiveReader::new(bytes, 0, "test")).map(|_| ()).unwrap_err().to_string()
    }
    assert!(refused::<bool>(&[2]).contains("neither true nor false"));
    assert!(refused::<String>(&[1, 0, 0, 0, 0, 0, 0, 0, 0xff]).contains("not UTF-8"));
    assert!(refused::<[f64; 2]>(&[0; 12]).contains("8 bytes are needed, 4 are left"));
    assert!(refused::<Arc<f64>>(&[7, 0, 0, 0]).contains("shared object 7"));
    assert!(refused::<Weekday>(&[7]).contains("7 is no Weekday"));
}
