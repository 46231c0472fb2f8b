#pragma once

/// Marks what the shared libraries show to programs. Everything else is hidden. On a namespace the mark holds for all
/// declarations within its braces.
#define PCL_SYMMETRY_EXPORTS [[gnu::visibility("default")]]
