// A strict reader of the XML that the project writes: what it takes is well-formed.
#ifndef BRDFIT_TESTS_XML_READER_H_
#define BRDFIT_TESTS_XML_READER_H_

#include <cctype>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace brdfit::tests {

struct XmlElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;               // of it and of what is in it
  std::vector<std::size_t> path;  // indices of the elements that it is in, outermost first

  double number(const std::string& attribute) const { return std::stod(attributes.at(attribute)); }
  bool has_class(const std::string& name_of_class) const {
    const auto found = attributes.find("class");
    return found != attributes.end() && found->second == name_of_class;
  }
};

// Reads elements, attributes in double quotes, text and the five named entities, numbers too. No comments, no
// CDATA, no name spaces. Throws std::runtime_error with the place of what is wrong.
class XmlReader {
 public:
  explicit XmlReader(std::string text) : owned_(std::move(text)), text_(owned_) {
    if (starts_with("<?xml ")) at_ = find("?>") + 2;
    skip_space();
    require(starts_with("<"), "no element");
    read_element({});
    skip_space();
    require(at_ == text_.size(), "text behind the end");
  }

  XmlReader(const XmlReader&) = delete;
  XmlReader& operator=(const XmlReader&) = delete;

  // In the order of the file.
  const std::vector<XmlElement>& elements() const { return elements_; }

 private:
  void require(bool is_right, const std::string& what) const {
    if (!is_right) throw std::runtime_error("XML at byte " + std::to_string(at_) + ": " + what);
  }
  bool starts_with(std::string_view word) const { return text_.substr(at_).starts_with(word); }
  std::size_t find(std::string_view word) const {
    const std::size_t found = text_.find(word, at_);
    require(found != std::string_view::npos, "no " + std::string(word));
    return found;
  }
  void skip_space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }
  void expect(std::string_view word) {
    require(starts_with(word), "not " + std::string(word));
    at_ += word.size();
  }
  std::string read_name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 ||
                                  text_[at_] == '-' || text_[at_] == ':')) {
      ++at_;
    }
    require(at_ > begin && std::isalpha(static_cast<unsigned char>(text_[begin])) != 0, "not a name");
    return std::string(text_.substr(begin, at_ - begin));
  }
  // One character, or what an entity stands for.
  std::string read_character() {
    const auto byte = static_cast<unsigned char>(text_[at_]);
    require(byte >= 0x20 || byte == '\n' || byte == '\t' || byte == '\r', "a control character");
    require(byte != '<', "< in text");
    if (byte != '&') return std::string(1, text_[at_++]);
    const std::string entity(text_.substr(at_, find(";") + 1 - at_));
    at_ += entity.size();
    static const std::map<std::string, std::string> kEntities = {
        {"&amp;", "&"}, {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}};
    const auto found = kEntities.find(entity);
    require(found != kEntities.end(), "unknown entity " + entity);
    return found->second;
  }
  void read_attribute(XmlElement& element) {
    const std::string name = read_name();
    expect("=\"");
    std::string value;
    while (require(at_ < text_.size(), "an open quote"), text_[at_] != '"') value += read_character();
    ++at_;
    require(element.attributes.emplace(name, value).second, "two attributes " + name);
  }
  void read_element(const std::vector<std::size_t>& path) {
    const std::size_t index = elements_.size();
    elements_.emplace_back();
    expect("<");
    XmlElement element;
    element.name = read_name();
    element.path = path;
    while (std::isspace(static_cast<unsigned char>(text_[at_])) != 0) {
      skip_space();
      read_attribute(element);
    }
    if (starts_with("/>")) {
      at_ += 2;
    } else {
      expect(">");
      std::vector<std::size_t> inner = path;
      inner.push_back(index);
      while (!starts_with("</")) {
        require(at_ < text_.size(), "no end of " + element.name);
        if (text_[at_] == '<') {
          const std::size_t child = elements_.size();
          read_element(inner);
          element.text += elements_[child].text;
        } else {
          element.text += read_character();
        }
      }
      expect("</" + element.name + ">");
    }
    elements_[index] = element;
  }

  std::string owned_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<XmlElement> elements_;
};

}  // namespace brdfit::tests

#endif  // BRDFIT_TESTS_XML_READER_H_
