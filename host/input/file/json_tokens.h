#pragma once
// JSON text token by token, with places: for what is to be said of text that has been found wrong. What is
// right is not decided here, but by json_file.h.

#include <cstddef>
#include <string>
#include <string_view>

namespace pmdsim {

struct JsonToken {
  enum class Kind {
    open_object,
    close_object,
    open_array,
    close_array,
    colon,
    comma,
    text, // in double quotes, closed
    word, // a number, true, false, null, or anything else between blanks and signs
    end,
  };
  Kind kind;
  std::size_t begin; // bytes from the front of the text
  std::size_t end;   // one past the last; of a text that is not closed, where its line ends
  bool closed = true;
};

class JsonTokens {
public:
  // `text` outlives it. A byte order mark is no part of any token.
  explicit JsonTokens(std::string_view text);

  // Behind blanks and comments, // and /* */; `end` again and again at the end.
  JsonToken next();

private:
  void skip_blanks();
  JsonToken text_token();

  std::string_view text_;
  std::size_t at_ = 0;
};

// What a text token says, without quotes and with its escapes as characters; as it is written where its
// escapes are wrong.
std::string json_text_of(std::string_view text, const JsonToken &token);

} // namespace pmdsim
