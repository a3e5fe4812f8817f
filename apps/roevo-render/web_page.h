#pragma once
#include <cstddef>
#include <string>

namespace roevo {

/// The page of a 3-D view (folder web/), with three.js in it.
/// @param title  HTML, escaped. @param data  JSON, fit for a script element
std::string webPage(const std::string& title, const std::string& data);

/// Bytes of the page without data.
std::size_t webPageSize();

}  // namespace roevo
