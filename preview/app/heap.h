// What the window asks of the C library's heap, so that a session of hours holds no more than one of minutes.
// Depends on nothing; does nothing where the library is not glibc.
#pragma once

namespace nephele {

/// Call once, before there are threads. Large blocks (volumes, textures of a driver that draws on the CPU,
/// pictures read back) lie by themselves from then on and go back to the system when they are freed. By
/// default glibc puts them among the small ones once one of their size was freed, where every new size widens
/// the heap.
void keepLargeBlocksApart();

/// Gives back what freed small blocks have left.
void returnFreeMemory();

}  // namespace nephele
