// What all pages share: one HTML file with its style and script in it, which loads nothing.
#ifndef BRDFIT_RENDER_REPORT_PAGE_H_
#define BRDFIT_RENDER_REPORT_PAGE_H_

#include <string>

namespace brdfit::render {

struct Page {
  std::string title;    // plain text
  std::string version;  // of brdfit, plain text
  std::string body;     // HTML
  std::string style;    // CSS beside that of all pages
  // Runs at the end of the page. There is a function makeSortable(table, say), and an element "said" whose
  // text is read aloud.
  std::string script;
};

// The file's text, UTF-8. A policy in it makes browsers refuse to load anything.
std::string page_html(const Page& page);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_REPORT_PAGE_H_
