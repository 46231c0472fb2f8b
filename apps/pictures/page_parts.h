/// The parts of a page that are the same for all shapes; made of page.html, three.min.js and viewer.js by CMake.
#pragma once

namespace pcl_symmetry::apps {

extern const char* const kPageHead;     ///< HTML up to the first script
extern const char* const kPageLibrary;  ///< three.js with its licence
extern const char* const kPageViewer;   ///< JavaScript

}  // namespace pcl_symmetry::apps
