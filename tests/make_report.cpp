// Writes a report for the test in a browser: make_report FILE [MATERIALS].
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

#include "io/image_file.h"
#include "tests/report_data.h"

int main(int count, char** arguments) {
  if (count < 2) {
    std::cerr << "usage: make_report FILE [MATERIALS]\n";
    return 2;
  }
  try {
    const int materials = count > 2 ? std::atoi(arguments[2]) : 5;
    brdfit::io::write_text(arguments[1], brdfit::render::report_html(brdfit::testing_support::sample_report(
                                             materials, materials < 20)));
  } catch (const std::exception& error) {
    std::cerr << "make_report: " << error.what() << '\n';
    return 1;
  }
}
