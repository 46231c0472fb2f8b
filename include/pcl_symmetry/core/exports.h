#pragma once

/// Exports declarations from the shared libraries, which hide everything else. On a namespace, it applies to all
/// declarations within its braces.
#define PCL_SYMMETRY_EXPORTS [[gnu::visibility("default")]]
