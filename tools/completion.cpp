// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan completion: a script that completes commands, options and their words in a shell.
#include <nlohmann/json.hpp>

#include "tools/commands.h"

namespace scan {
namespace {

struct Word {
  std::string name;                  // with its dashes
  std::vector<std::string> choices;  // of its value, if they are known
  std::string help;
  bool takes_value = true;
};

// Notes what a command declares; nothing is read.
class WordList : public CommandLine {
 public:
  std::vector<Word> options;
  std::vector<std::string> first_words;  // what the first positional argument may be, if known

  void input(std::string, std::string&, std::string) override {}
  void inputs(std::string, std::vector<std::string>&, std::string) override {}
  void option(std::string name, std::string&, std::string help) override {
    options.push_back({std::move(name), {}, std::move(help)});
  }
  void choice(std::string name, std::string&, std::vector<std::string> choices,
              std::string help) override {
    if (name.starts_with("-"))
      options.push_back({std::move(name), std::move(choices), std::move(help)});
    else
      first_words = std::move(choices);
  }
  void whole(std::string name, long&, long, long, std::string help) override {
    options.push_back({std::move(name), {}, std::move(help)});
  }
  void number(std::string name, double&, double, double, std::string help) override {
    options.push_back({std::move(name), {}, std::move(help)});
  }
  void length(std::string name, double&, std::string help) override {
    options.push_back({std::move(name), {}, std::move(help)});
  }
  void angle(std::string name, double&, std::string help) override {
    options.push_back({std::move(name), {}, std::move(help)});
  }
  void flag(std::string name, bool&, std::string help) override {
    options.push_back({std::move(name), {}, std::move(help), false});
  }
};

WordList words_of(const Command& command) {
  WordList words;
  (void)command.declare(words);
  Console console;
  declare_shared_options(words, console);
  words.flag("--help", console.json, "print the help and exit");
  return words;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::string in_quotes(const std::string& text) {
  std::string safe = "'";
  for (const char c : text) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return safe + "'";
}

// "-q,--quiet" in its long form.
std::string long_form(const std::string& name) {
  return name.substr(name.rfind("--"));
}

// One `case` of the word before and one of the command; file names are the shell's own affair.
std::string bash_script(const std::vector<Command>& commands) {
  std::string values, options, names;
  for (const Command& command : commands) {
    const WordList words = words_of(command);
    names += (names.empty() ? "" : " ") + command.name;
    std::string list;
    for (const Word& option : words.options) {
      list += (list.empty() ? "" : " ") + long_form(option.name);
      if (!option.choices.empty())
        values += "    '" + command.name + " " + option.name + "') words='" +
                  joined(option.choices) + "' ;;\n";
    }
    if (!words.first_words.empty())
      values += "    '" + command.name + " " + command.name + "') words='" +
                joined(words.first_words) + "' ;;\n";
    options += "      " + command.name + ") words='" + list + "' ;;\n";
  }
  return "_scan() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words=\n"
         "  case \"${COMP_WORDS[1]} $before\" in\n" +
         values +
         "  esac\n"
         "  if [ \"$COMP_CWORD\" = 1 ]; then\n"
         "    words='" +
         names +
         "'\n"
         "  elif [ \"${word#-}\" != \"$word\" ]; then\n"
         "    case \"${COMP_WORDS[1]}\" in\n" +
         options +
         "    esac\n"
         "  fi\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         "}\n"
         "complete -o default -F _scan scan\n";
}

std::string fish_script(const std::vector<Command>& commands) {
  std::string script;
  for (const Command& command : commands) {
    script += "complete -c scan -n __fish_use_subcommand -f -a " + command.name + " -d " +
              in_quotes(command.summary) + "\n";
    const std::string within =
        "complete -c scan -n '__fish_seen_subcommand_from " + command.name + "'";
    const WordList words = words_of(command);
    if (!words.first_words.empty())
      script += within + " -a " + in_quotes(joined(words.first_words)) + "\n";
    for (const Word& option : words.options) {
      script += within + " -l " + long_form(option.name).substr(2);
      if (option.takes_value) script += " -r";
      if (!option.choices.empty()) script += " -f -a " + in_quotes(joined(option.choices));
      script += " -d " + in_quotes(option.help) + "\n";
    }
  }
  return script;
}

std::string script_for(const std::string& shell) {
  const std::vector<Command> commands = all_commands();
  if (shell == "fish") return fish_script(commands);
  const std::string bash = bash_script(commands);
  return shell == "bash" ? bash : "autoload -U +X bashcompinit && bashcompinit\n" + bash;
}

}  // namespace

Action completion_command(CommandLine& line) {
  auto shell = std::make_shared<std::string>("bash");
  line.choice("SHELL", *shell, {"bash", "zsh", "fish"}, "whose script to print");
  return [shell](Console& console) {
    const std::string script = script_for(*shell);
    console.say(script);
    console.finish("completion", "ok", {{"shell", *shell}, {"script", script}});
    return 0;
  };
}

}  // namespace scan
